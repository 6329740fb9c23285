#include "src/colmap/step_bar.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <streambuf>

namespace tapa {

struct ColmapStep {
  // In the heading that it begins with.
  const char* heading;
  // How the lines begin that tell how far it is; nullptr: there are none, or it
  // shows that by itself.
  const char* line;
  // For the user.
  const char* name;
};

namespace {

constexpr ColmapStep kSteps[] = {
    {"Feature extraction", "Processed file [", "Finding features"},
    {"feature matching", "Matching ", "Matching features"},
    {"Loading database", "Registering image #", "Finding camera poses"},
    {"Image undistortion", "Undistorting image [", "Undistorting photographs"},
    {"Dense stereo", nullptr, nullptr},
    {"StereoFusion::Options", "Fusing image [", "Fusing"},
};

// Share of a step that is done by a line such as "Processed file [5/11]",
// "Matching block [1/3, 2/3] in 0.1s" or, of so many images, "Registering image
// #7 (5)"; 0 if it does not tell.
double ReadShare(const std::string& line, int num_images) {
  int index = 0;
  int count = 0;
  int inner_index = 0;
  int inner_count = 0;
  const char* bracket = std::strchr(line.c_str(), '[');
  const int num_read = bracket == nullptr
                           ? 0
                           : std::sscanf(bracket, "[%d/%d, %d/%d]", &index,
                                         &count, &inner_index, &inner_count);
  if (num_read == 4 && count > 0 && inner_count > 0) {
    return (index - 1 + 1.0 * inner_index / inner_count) / count;
  }
  if (num_read == 2 && count > 0) {
    return 1.0 * index / count;
  }
  if (num_images > 0 && std::sscanf(line.c_str(), "Registering image #%d (%d)",
                                    &inner_index, &index) == 2) {
    return 1.0 * index / num_images;
  }
  return 0;
}

double Now() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

}  // namespace

void StepReader::Read(const std::string& line, double seconds) {
  for (const ColmapStep& step : kSteps) {
    if (line.find(step.heading) != std::string::npos) {
      step_ = &step;
      begin_ = seconds;
      share_ = 0;
      return;
    }
  }
  int connected = 0;
  if (std::sscanf(line.c_str(), "Loading images... %*d in %*fs (connected %d)",
                  &connected) == 1) {
    num_images_ = connected;
  }
  if (step_ != nullptr && step_->line != nullptr &&
      line.compare(0, std::strlen(step_->line), step_->line) == 0) {
    share_ = ReadShare(line, num_images_);
  }
}

std::string StepReader::Bar(double seconds) const {
  // What a step does after its last photograph cannot be foreseen.
  if (share_ <= 0 || share_ >= 1) {
    return "";
  }
  constexpr int kWidth = 20;
  std::string bar(kWidth, ' ');
  bar.replace(0, static_cast<size_t>(share_ * kWidth),
              static_cast<size_t>(share_ * kWidth), '#');
  return "[" + bar + "] " + TimeToGo(share_, seconds - begin_) + "  " +
         step_->name;
}

// Hands on what is printed to a stream, such that the bar stays below.
class StepBar::Stream : public std::streambuf {
 public:
  Stream(std::ostream* stream, StepBar* bar)
      : stream_(stream), bar_(bar), target_(stream->rdbuf(this)) {}
  ~Stream() override {
    HandOn();
    stream_->rdbuf(target_);
  }

 protected:
  int_type overflow(int_type c) override {
    const char character = traits_type::to_char_type(c);
    xsputn(&character, 1);
    return traits_type::not_eof(c);
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    const std::lock_guard<std::mutex> lock(bar_->mutex_);
    for (std::streamsize i = 0; i < size; ++i) {
      line_ += text[i];
      if (text[i] == '\n') {
        EndLine();
      }
    }
    return size;
  }

  // The first part of a line waits for its end while it would hide the bar.
  int sync() override {
    const std::lock_guard<std::mutex> lock(bar_->mutex_);
    if (!bar_->line_.IsShown()) {
      HandOn();
    }
    return 0;
  }

 private:
  void HandOn() {
    target_->sputn(line_.data() + num_handed_on_,
                   line_.size() - num_handed_on_);
    target_->pubsync();
    num_handed_on_ = line_.size();
  }

  void EndLine() {
    bar_->line_.Clear();
    HandOn();
    // What goes to stderr may be the last that is printed.
    if (stream_ == &std::cout) {
      line_.pop_back();
      bar_->reader_.Read(line_, Now());
      const std::string text = bar_->reader_.Bar(Now());
      if (!text.empty()) {
        bar_->line_.Show(text);
      }
    }
    line_.clear();
    num_handed_on_ = 0;
  }

  std::ostream* const stream_;
  StepBar* const bar_;
  std::streambuf* const target_;
  // The line that is being printed, and how much of it has been handed on.
  std::string line_;
  size_t num_handed_on_ = 0;
};

StepBar::StepBar() {
  if (isatty(STDOUT_FILENO) && isatty(STDERR_FILENO)) {
    cout_ = std::make_unique<Stream>(&std::cout, this);
    cerr_ = std::make_unique<Stream>(&std::cerr, this);
  }
}

StepBar::~StepBar() { line_.Clear(); }

}  // namespace tapa
