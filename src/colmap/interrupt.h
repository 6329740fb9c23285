#ifndef TAPA_SRC_COLMAP_INTERRUPT_H_
#define TAPA_SRC_COLMAP_INTERRUPT_H_

#include <csignal>

namespace tapa {

// While one of these lives, the first SIGINT or SIGTERM is only noted, so that
// the work can end in order; a second one ends the program at once. The
// handlers found before are restored at the end. Do not nest. Of a guest
// (guest.h) none is noted.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();

  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  // Number of the signal that has come, 0: none.
  int Signal() const;

 private:
  const bool is_off_;
  struct sigaction old_int_;
  struct sigaction old_term_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_INTERRUPT_H_
