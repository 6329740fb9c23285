#ifndef TAPA_SRC_COLMAP_PROGRESS_H_
#define TAPA_SRC_COLMAP_PROGRESS_H_

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "src/colmap/pass.h"

namespace tapa {

void PrintWarning(const std::string& text);

// Tells the user how far a run is: a line per finished view and, on a terminal,
// one that is renewed in place while a view is computed. Work is measured in
// megapixels, times passes. Several views may be computed at a time, by threads
// of their own.
class Progress {
 public:
  // total: megapixels that the run has to compute.
  explicit Progress(double total);

  // what: number and name of the view, for the user. Returns the number by
  // which the functions below know the view.
  int BeginView(Pass pass, const std::string& what, double megapixels);
  // share: part of the view that is done, 0 to 1.
  void Update(int view, double share);
  void EndView(int view);
  // Clears the line that is renewed in place, before something else is printed.
  void ClearLine();

  // Prints seconds per megapixel and view.
  void PrintSummary() const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Totals {
    double megapixels = 0;
    double seconds = 0;
    double cpu_seconds = 0;
  };

  struct View {
    Pass pass;
    std::string what;
    double megapixels;
    Clock::time_point begin;
    double cpu_begin;
    double share = 0;
  };

  // All with the mutex held.
  std::string TimeToGo() const;
  void Clear();
  // Adds the time since the last call to the pass that is running.
  void CountTime();

  const double total_;
  const bool is_terminal_;
  std::mutex mutex_;
  bool line_shown_ = false;
  // Time during which several views are computed counts once.
  std::map<Pass, Totals> passes_;
  std::map<int, View> running_;
  int next_view_ = 0;
  // The one that is running.
  Pass pass_ = Pass::kPhotometric;
  Clock::time_point last_count_;
  double last_cpu_count_ = 0;
  Clock::time_point last_update_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROGRESS_H_
