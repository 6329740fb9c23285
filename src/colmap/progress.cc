#include "src/colmap/progress.h"

#include <algorithm>
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

}  // namespace

void PrintWarning(const std::string& text) {
  std::cout << "WARNING: " << text << std::endl;
}

Progress::Progress(double total_work, ProgressListener listener)
    : total_work_(total_work), listener_(std::move(listener)) {}

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

int Progress::BeginView(const ViewWork& view) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CountTime();
  place_ = {view.level, view.pass};
  last_update_ = last_count_;
  running_[next_view_] = {view, last_count_, last_cpu_count_};
  return next_view_++;
}

std::string Progress::View::Name() const {
  return (of.level > 0 ? Format("level %d ", of.level) : "") +
         PassName(of.pass) + " " + of.number + " " + of.name;
}

double Progress::ShareDone() const {
  double done = work_done_;
  for (const auto& [number, view] : running_) {
    done += view.share * view.of.work;
  }
  return total_work_ > 0 ? std::min(1.0, done / total_work_) : 1.0;
}

std::string Progress::Text(const View& view) const {
  double seconds = 0;
  for (const auto& [place, totals] : passes_) {
    seconds += totals.seconds;
  }
  return TimeToGo(ShareDone(), seconds) + "  " + view.Name();
}

void Progress::Tell(const View& view, bool is_finished) const {
  if (listener_) {
    ProgressNews news;
    news.share = ShareDone();
    news.text = Text(view) + (view.of.level == 0 ? ", full size" : "");
    if (is_finished && IsResult(view.of.pass, view.of.level)) {
      news.finished_view = view.of.name;
      news.finished_pass = view.of.pass;
    }
    listener_(news);
  }
}

void Progress::Update(int number, double share) {
  const std::lock_guard<std::mutex> lock(mutex_);
  View& view = running_.at(number);
  view.share = share;
  const Clock::time_point now = Clock::now();
  if (now - last_update_ < kUpdateInterval) {
    return;
  }
  last_update_ = now;
  CountTime();
  const double seconds =
      std::chrono::duration<double>(now - view.begin).count();
  const double done = share * view.of.megapixels;
  const std::string speed =
      done > 0 ? Format(", %.1f s per megapixel", seconds / done) : "";
  line_.Show(Text(view) + Format(": %.0f %%", 100 * share) + speed);
  Tell(view, false);
}

void Progress::EndView(int number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CountTime();
  const View view = running_.at(number);
  const bool alone = running_.size() == 1;
  running_.erase(number);
  const double megapixels = view.of.megapixels;
  passes_[{view.of.level, view.of.pass}].megapixels += megapixels;
  work_done_ += view.of.work;
  const double seconds =
      std::chrono::duration<double>(last_count_ - view.begin).count();
  // Other views' CPU time cannot be told from this one's.
  const std::string cpu =
      alone ? Format(" (CPU %.1f s)",
                     (last_cpu_count_ - view.cpu_begin) / megapixels)
            : "";
  line_.Clear();
  std::cout << Text(view)
            << Format(": %.2f megapixels in %.1f s, %.1f s", megapixels,
                      seconds, seconds / megapixels)
            << cpu << " per megapixel" << std::endl;
  Tell(view, true);
}

void Progress::ClearLine() {
  const std::lock_guard<std::mutex> lock(mutex_);
  line_.Clear();
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
