#ifndef TAPA_SRC_COLMAP_PROGRESS_H_
#define TAPA_SRC_COLMAP_PROGRESS_H_

#include <array>
#include <chrono>
#include <string>

namespace tapa {

// Tells the user how far a run is: a line per finished view and, on a terminal,
// one that is renewed in place while a view is computed. Work is measured in
// megapixels, times passes.
class Progress {
 public:
  // total: megapixels that the run has to compute.
  explicit Progress(double total);

  // what: name of the view, where: its pass and number, for the user.
  void BeginView(const std::string& where, const std::string& what,
                 bool geometric, double megapixels);
  // share: part of the view that is done, 0 to 1.
  void Update(double share);
  void EndView();
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

  std::string TimeToGo(double done, double seconds) const;

  const double total_;
  const bool is_terminal_;
  bool line_shown_ = false;
  // Of the photometric and of the geometric pass.
  std::array<Totals, 2> passes_;

  std::string where_;
  std::string what_;
  bool geometric_ = false;
  double megapixels_ = 0;
  Clock::time_point begin_;
  Clock::time_point last_update_;
  double cpu_begin_ = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROGRESS_H_
