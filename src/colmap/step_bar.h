#ifndef TAPA_SRC_COLMAP_STEP_BAR_H_
#define TAPA_SRC_COLMAP_STEP_BAR_H_

#include <memory>
#include <mutex>
#include <string>

#include "src/colmap/terminal_line.h"

namespace tapa {

struct ColmapStep;

// Knows from the lines that COLMAP prints how far it is with those of its steps
// that take long.
class StepReader {
 public:
  // seconds: when the line was printed, by any clock.
  void Read(const std::string& line, double seconds);
  // A bar with the time to go and the name of the step; empty: nothing is
  // known.
  std::string Bar(double seconds) const;

 private:
  const ColmapStep* step_ = nullptr;
  double begin_ = 0;
  double share_ = 0;
  // Of the mapper.
  int num_images_ = 0;
};

// While one of these lives, and all is printed to a terminal, a bar below what
// COLMAP prints tells how far its step is. The lines themselves stay as they
// are.
class StepBar {
 public:
  StepBar();
  ~StepBar();

  StepBar(const StepBar&) = delete;
  StepBar& operator=(const StepBar&) = delete;

 private:
  class Stream;

  // Held while anything is printed.
  std::mutex mutex_;
  StepReader reader_;
  TerminalLine line_;
  // In the place of those of std::cout and std::cerr.
  std::unique_ptr<Stream> cout_;
  std::unique_ptr<Stream> cerr_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_STEP_BAR_H_
