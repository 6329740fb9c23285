#include "src/colmap/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>

namespace tapa {
namespace {

constexpr std::chrono::milliseconds kUpdateInterval(300);

// Seconds that all threads of the program have computed for.
double CpuSeconds() {
  timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

template <typename... Args>
std::string Format(const char* format, Args... args) {
  char text[512];
  std::snprintf(text, sizeof(text), format, args...);
  return text;
}

std::string TimeText(double seconds) {
  const long s = std::lround(std::max(0.0, std::min(seconds, 1e9)));
  return Format("%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

void PrintWarning(const std::string& text) {
  std::cout << "WARNING: " << text << std::endl;
}

Progress::Progress(double total_work)
    : total_work_(total_work), is_terminal_(isatty(STDOUT_FILENO)) {}

void Progress::CountTime() {
  const Clock::time_point now = Clock::now();
  const double cpu_now = CpuSeconds();
  if (!running_.empty()) {
    Totals& pass = passes_[place_];
    pass.seconds += std::chrono::duration<double>(now - last_count_).count();
    pass.cpu_seconds += cpu_now - last_cpu_count_;
  }
  last_count_ = now;
  last_cpu_count_ = cpu_now;
}

int Progress::BeginView(Pass pass, int level, const std::string& what,
                        double megapixels, double work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CountTime();
  place_ = {level, pass};
  last_update_ = last_count_;
  const std::string name =
      (level > 0 ? Format("level %d ", level) : "") + PassName(pass);
  running_[next_view_] = {place_, name + " " + what, megapixels,
                          work,   last_count_,       last_cpu_count_};
  return next_view_++;
}

std::string Progress::TimeToGo() const {
  double done = work_done_;
  double seconds = 0;
  for (const auto& [place, totals] : passes_) {
    seconds += totals.seconds;
  }
  for (const auto& [number, view] : running_) {
    done += view.share * view.work;
  }
  const double share =
      total_work_ > 0 ? std::min(1.0, done / total_work_) : 1.0;
  return Format(
      "%5.1f %%  %s to go", 100 * share,
      share > 0 ? TimeText(seconds * (1 - share) / share).c_str() : "?");
}

void Progress::Update(int number, double share) {
  const std::lock_guard<std::mutex> lock(mutex_);
  View& view = running_.at(number);
  view.share = share;
  const Clock::time_point now = Clock::now();
  if (!is_terminal_ || now - last_update_ < kUpdateInterval) {
    return;
  }
  last_update_ = now;
  CountTime();
  const double seconds =
      std::chrono::duration<double>(now - view.begin).count();
  const double done = share * view.megapixels;
  const std::string speed =
      done > 0 ? Format(", %.1f s per megapixel", seconds / done) : "";
  const std::string line = "\r\033[K" + TimeToGo() + "  " + view.what + ": " +
                           Format("%.0f %%", 100 * share) + speed;
  // To the terminal alone: the graphical interface keeps a log of std::cout.
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
  line_shown_ = true;
}

void Progress::EndView(int number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CountTime();
  const View view = running_.at(number);
  const bool alone = running_.size() == 1;
  running_.erase(number);
  passes_[view.place].megapixels += view.megapixels;
  work_done_ += view.work;
  const double seconds =
      std::chrono::duration<double>(last_count_ - view.begin).count();
  // Other views' CPU time cannot be told from this one's.
  const std::string cpu =
      alone ? Format(" (CPU %.1f s)",
                     (last_cpu_count_ - view.cpu_begin) / view.megapixels)
            : "";
  Clear();
  std::cout << TimeToGo() << "  " << view.what
            << Format(": %.2f megapixels in %.1f s, %.1f s", view.megapixels,
                      seconds, seconds / view.megapixels)
            << cpu << " per megapixel" << std::endl;
}

void Progress::ClearLine() {
  const std::lock_guard<std::mutex> lock(mutex_);
  Clear();
}

void Progress::Clear() {
  if (line_shown_) {
    std::fputs("\r\033[K", stdout);
    std::fflush(stdout);
    line_shown_ = false;
  }
}

void Progress::PrintSummary() const {
  // Per pixel of full size, so that coarse levels count for what they cost.
  std::string text;
  double full_megapixels = 0;
  double seconds = 0;
  double cpu_seconds = 0;
  double coarse_seconds = 0;
  double coarse_cpu_seconds = 0;
  for (const auto& [place, totals] : passes_) {
    if (place.level > 0) {
      coarse_seconds += totals.seconds;
      coarse_cpu_seconds += totals.cpu_seconds;
    } else if (totals.megapixels > 0) {
      const double pass_seconds = totals.seconds / totals.megapixels;
      const double pass_cpu_seconds = totals.cpu_seconds / totals.megapixels;
      text += Format("%s %.1f (CPU %.1f), ", PassName(place.pass), pass_seconds,
                     pass_cpu_seconds);
      full_megapixels = std::max(full_megapixels, totals.megapixels);
      seconds += pass_seconds;
      cpu_seconds += pass_cpu_seconds;
    }
  }
  if (text.empty()) {
    return;
  }
  if (coarse_seconds > 0) {
    coarse_seconds /= full_megapixels;
    coarse_cpu_seconds /= full_megapixels;
    text = Format("coarse levels %.1f (CPU %.1f), ", coarse_seconds,
                  coarse_cpu_seconds) +
           text;
    seconds += coarse_seconds;
    cpu_seconds += coarse_cpu_seconds;
  }
  std::cout << "Seconds per megapixel and view: " << text << "together "
            << Format("%.1f (CPU %.1f)", seconds, cpu_seconds) << std::endl;
}

}  // namespace tapa
