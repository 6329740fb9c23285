#ifndef TAPA_SRC_COLMAP_TERMINAL_LINE_H_
#define TAPA_SRC_COLMAP_TERMINAL_LINE_H_

#include <string>

namespace tapa {

// " 58.3 %  0:04:03 to go", for work of which a share, 0 to 1, took so many
// seconds.
std::string TimeToGo(double share, double seconds);

// The last line on the terminal, renewed in place. It goes to stderr, so that
// what is printed to stdout can be kept in a log meanwhile. Where stderr is no
// terminal, and of a guest (guest.h), nothing is shown.
class TerminalLine {
 public:
  TerminalLine();
  ~TerminalLine() { Clear(); }

  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  void Show(const std::string& text);
  // To be called before anything else is printed.
  void Clear();
  bool IsShown() const { return is_shown_; }

 private:
  const bool is_terminal_;
  bool is_shown_ = false;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_TERMINAL_LINE_H_
