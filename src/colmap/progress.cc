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

Progress::Progress(double total)
    : total_(total), is_terminal_(isatty(STDOUT_FILENO)) {}

void Progress::BeginView(const std::string& where, const std::string& what,
                         bool geometric, double megapixels) {
  where_ = where;
  what_ = what;
  geometric_ = geometric;
  megapixels_ = megapixels;
  begin_ = Clock::now();
  last_update_ = begin_;
  cpu_begin_ = CpuSeconds();
}

// done: megapixels of the current view; seconds: spent on it.
std::string Progress::TimeToGo(double done, double seconds) const {
  for (const Totals& pass : passes_) {
    done += pass.megapixels;
    seconds += pass.seconds;
  }
  const double share = total_ > 0 ? std::min(1.0, done / total_) : 1.0;
  return Format(
      "%5.1f %%  %s to go", 100 * share,
      share > 0 ? TimeText(seconds * (1 - share) / share).c_str() : "?");
}

void Progress::Update(double share) {
  const Clock::time_point now = Clock::now();
  if (!is_terminal_ || now - last_update_ < kUpdateInterval) {
    return;
  }
  last_update_ = now;
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  const double done = share * megapixels_;
  const std::string speed =
      done > 0 ? Format(", %.1f s per megapixel", seconds / done) : "";
  const std::string line = "\r\033[K" + TimeToGo(done, seconds) + "  " +
                           where_ + " " + what_ + ": " +
                           Format("%.0f %%", 100 * share) + speed;
  // To the terminal alone: the graphical interface keeps a log of std::cout.
  std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
  line_shown_ = true;
}

void Progress::EndView() {
  const double seconds =
      std::chrono::duration<double>(Clock::now() - begin_).count();
  const double cpu_seconds = CpuSeconds() - cpu_begin_;
  Totals& pass = passes_[geometric_];
  pass.megapixels += megapixels_;
  pass.seconds += seconds;
  pass.cpu_seconds += cpu_seconds;
  ClearLine();
  std::cout << TimeToGo(0, 0) << "  " << where_ << " " << what_
            << Format(
                   ": %.2f megapixels in %.1f s, %.1f s (CPU %.1f s) per "
                   "megapixel",
                   megapixels_, seconds, seconds / megapixels_,
                   cpu_seconds / megapixels_)
            << std::endl;
}

void Progress::ClearLine() {
  if (line_shown_) {
    std::fputs("\r\033[K", stdout);
    std::fflush(stdout);
    line_shown_ = false;
  }
}

void Progress::PrintSummary() const {
  const char* names[] = {"photometric", "geometric"};
  double seconds = 0;
  double cpu_seconds = 0;
  int num_passes = 0;
  std::string text;
  for (int i = 0; i < 2; ++i) {
    const Totals& pass = passes_[i];
    if (pass.megapixels > 0) {
      text += Format("%s %.1f (CPU %.1f), ", names[i],
                     pass.seconds / pass.megapixels,
                     pass.cpu_seconds / pass.megapixels);
      seconds += pass.seconds / pass.megapixels;
      cpu_seconds += pass.cpu_seconds / pass.megapixels;
      ++num_passes;
    }
  }
  if (num_passes > 0) {
    std::cout << "Seconds per megapixel and view: " << text << "together "
              << Format("%.1f (CPU %.1f)", seconds, cpu_seconds) << std::endl;
  }
}

}  // namespace tapa
