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
// one that is renewed in place while a view is computed. Several views may be
// computed at a time, by threads of their own.
class Progress {
 public:
  // total_work: what the run has to compute, in any unit.
  explicit Progress(double total_work);

  // what: number and name of the view, for the user. work: its share of the
  // total. Returns the number by which the functions below know the view.
  int BeginView(Pass pass, int level, const std::string& what,
                double megapixels, double work);
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
    Place place;
    std::string what;
    double megapixels;
    double work;
    Clock::time_point begin;
    double cpu_begin;
    double share = 0;
  };

  // All with the mutex held.
  std::string TimeToGo() const;
  void Clear();
  // Adds the time since the last call to the pass that is running.
  void CountTime();

  const double total_work_;
  const bool is_terminal_;
  std::mutex mutex_;
  bool line_shown_ = false;
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
