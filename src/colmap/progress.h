#ifndef TAPA_SRC_COLMAP_PROGRESS_H_
#define TAPA_SRC_COLMAP_PROGRESS_H_

#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "src/colmap/pass.h"
#include "src/colmap/progress_news.h"
#include "src/colmap/terminal_line.h"

namespace tapa {

void PrintWarning(const std::string& text);

// A view to compute in a pass at a level.
struct ViewWork {
  Pass pass;
  int level;
  // Such as "3/12".
  std::string number;
  std::string name;
  double megapixels;
  // What it takes, in any unit.
  double work;
};

// Tells the user how far a run is: a line per finished view and, on a terminal,
// one that is renewed in place while a view is computed. Several views may be
// computed at a time, by threads of their own.
class Progress {
 public:
  // total_work: what the run has to compute, in the unit of ViewWork.
  explicit Progress(double total_work, ProgressListener listener = nullptr);

  // Returns the number by which the functions below know the view.
  int BeginView(const ViewWork& view);
  // share: part of the view that is done, 0 to 1.
  void Update(int view, double share);
  void EndView(int view);
  // Clears the line that is renewed in place, before something else is printed.
  void ClearLine();

  // Prints seconds per megapixel and view.
  void PrintSummary() const;

 private:
  using Clock = std::chrono::steady_clock;

  // A pass at a level, in the order in which they are computed.
  struct Place {
    int level = 0;
    Pass pass = Pass::kPhotometric;
    bool operator<(const Place& other) const {
      return level != other.level ? level > other.level : pass < other.pass;
    }
  };

  struct Totals {
    double megapixels = 0;
    double seconds = 0;
    double cpu_seconds = 0;
  };

  struct View {
    ViewWork of;
    Clock::time_point begin;
    double cpu_begin;
    double share = 0;

    // For the user.
    std::string Name() const;
  };

  // All with the mutex held.
  double ShareDone() const;
  // How far all is, and a view with it.
  std::string Text(const View& view) const;
  void Tell(const View& view, bool is_finished) const;
  // Adds the time since the last call to the pass that is running.
  void CountTime();

  const double total_work_;
  const ProgressListener listener_;
  std::mutex mutex_;
  TerminalLine line_;
  // Time during which several views are computed counts once.
  std::map<Place, Totals> passes_;
  std::map<int, View> running_;
  int next_view_ = 0;
  double work_done_ = 0;
  // The one that is running.
  Place place_;
  Clock::time_point last_count_;
  double last_cpu_count_ = 0;
  Clock::time_point last_update_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROGRESS_H_
