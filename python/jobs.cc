#include "python/jobs.h"

#include <glog/logging.h>

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <functional>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <streambuf>
#include <thread>
#include <type_traits>
#include <utility>

#include "base/reconstruction.h"
#include "mvs/fusion.h"
#include "mvs/patch_match.h"
#include "src/colmap/dense_model.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/fused_points.h"
#include "src/colmap/fusion_input.h"
#include "src/colmap/fusion_option_list.h"
#include "src/colmap/guest.h"
#include "src/colmap/option_list.h"
#include "src/colmap/progress_news.h"
#include "util/misc.h"
#include "util/threading.h"

namespace tapa {
namespace {

// Reads what is printed to a stream, line by line.
class LineReader : public std::streambuf {
 public:
  using Listener = std::function<void(const std::string&)>;

  LineReader(std::ostream* stream, Listener listener)
      : listener_(std::move(listener)),
        stream_(stream),
        target_(stream->rdbuf(this)) {}

  // Leaves the stream. Threads that print meanwhile may still come here.
  void End() { stream_->rdbuf(target_); }

 protected:
  int_type overflow(int_type c) override {
    const char character = traits_type::to_char_type(c);
    xsputn(&character, 1);
    return traits_type::not_eof(c);
  }

  std::streamsize xsputn(const char* text, std::streamsize size) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::streamsize i = 0; i < size; ++i) {
      if (text[i] == '\n') {
        listener_(line_);
        line_.clear();
      } else {
        line_ += text[i];
      }
    }
    return size;
  }

 private:
  const Listener listener_;
  std::ostream* const stream_;
  std::streambuf* const target_;
  std::mutex mutex_;
  std::string line_;
};

// The tables of options that a task's may change.
template <typename Visitor>
void Visit(colmap::mvs::PatchMatchOptions* options, const Visitor& visit) {
  VisitOptions(options, visit);
}
template <typename Visitor>
void Visit(colmap::mvs::StereoFusionOptions* options, const Visitor& visit) {
  VisitStereoFusionOptions(options, visit);
}

template <typename Options>
JobOptions Defaults() {
  Options options;
  JobOptions values;
  Visit(&options, [&values](const OptionEntry& entry, const auto* value) {
    values[entry.name] = *value;
  });
  return values;
}

template <typename Options>
Options MakeOptions(const JobOptions& values) {
  Options options;
  Visit(&options, [&values](const OptionEntry& entry, auto* value) {
    const auto found = values.find(entry.name);
    if (found != values.end()) {
      *value = std::get<std::decay_t<decltype(*value)>>(found->second);
    }
  });
  return options;
}

}  // namespace

JobOptions StereoDefaults() {
  return Defaults<colmap::mvs::PatchMatchOptions>();
}

JobOptions FusionDefaults() {
  return Defaults<colmap::mvs::StereoFusionOptions>();
}

// What a job's threads share with whoever waits for it. Threads that a failed
// check leaves asleep keep it.
class JobState : public std::enable_shared_from_this<JobState> {
 public:
  // Throws std::runtime_error if another job is running.
  template <typename Task>
  void Start(const Task& task);

  bool Wait(double seconds);
  void Stop();
  // Joins its thread, unless that sleeps.
  void Leave();

  std::pair<double, std::string> Progress();
  std::vector<std::string> TakeLines();
  bool IsDone();
  std::vector<std::string> Errors();

 private:
  // The job that is running in this process, nullptr: none.
  static std::shared_ptr<JobState> Running();
  static void InitializeProcess();

  // Return the exit status of the command.
  int Compute(const StereoTask& task);
  int Compute(const FusionTask& task);
  // Lets a thread of COLMAP's do its work, such that Stop reaches it.
  void RunThread(colmap::Thread* thread);

  void AddLine(const std::string& line);
  void AddError(const std::string& error);
  void End(int status, bool is_asleep);

  static std::mutex running_mutex_;
  static std::shared_ptr<JobState> running_;

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable end_;
  // All below with the mutex held.
  colmap::Thread* computing_ = nullptr;
  bool is_stopped_ = false;
  bool has_ended_ = false;
  bool is_asleep_ = false;
  int status_ = EXIT_FAILURE;
  double share_ = 0;
  std::string text_;
  std::vector<std::string> lines_;
  std::vector<std::string> errors_;
  std::unique_ptr<LineReader> cout_;
  std::unique_ptr<LineReader> cerr_;
};

std::mutex JobState::running_mutex_;
std::shared_ptr<JobState> JobState::running_;

std::shared_ptr<JobState> JobState::Running() {
  const std::lock_guard<std::mutex> lock(running_mutex_);
  return running_;
}

void JobState::InitializeProcess() {
  static std::once_flag flag;
  std::call_once(flag, [] {
    // Otherwise every line of its log goes to stderr.
    if (!google::IsGoogleLoggingInitialized()) {
      google::InitGoogleLogging("tapa_mvs");
    }
    BecomeGuest({[](const std::string& error) {
                   if (const auto job = Running()) {
                     job->AddError(error);
                   }
                 },
                 [] {
                   if (const auto job = Running()) {
                     job->End(EXIT_FAILURE, /* is_asleep */ true);
                   }
                 }});
  });
}

template <typename Task>
void JobState::Start(const Task& task) {
  InitializeProcess();
  {
    const std::lock_guard<std::mutex> lock(running_mutex_);
    if (running_ != nullptr) {
      throw std::runtime_error(
          "Another run is going on in this process; wait until it has ended");
    }
    running_ = shared_from_this();
  }
  const auto add_line = [this](const std::string& line) { AddLine(line); };
  cout_ = std::make_unique<LineReader>(&std::cout, add_line);
  cerr_ = std::make_unique<LineReader>(&std::cerr, add_line);
  try {
    thread_ = std::thread([self = shared_from_this(), task] {
      int status = EXIT_FAILURE;
      try {
        status = self->Compute(task);
      } catch (const std::exception& error) {
        self->AddError(std::string(error.what()) + ".");
      }
      self->End(status, /* is_asleep */ false);
    });
  } catch (...) {
    End(EXIT_FAILURE, /* is_asleep */ false);
    throw;
  }
}

int JobState::Compute(const StereoTask& task) {
  const FatalErrors fatal_errors("Stereo failed");
  colmap::mvs::PatchMatchController controller(
      MakeOptions<colmap::mvs::PatchMatchOptions>(task.options),
      task.workspace_path, task.workspace_format, task.pmvs_option_name,
      task.config_path);
  controller.SetListener([this](const ProgressNews& news) {
    const std::lock_guard<std::mutex> lock(mutex_);
    share_ = news.share;
    text_ = news.text;
  });
  RunThread(&controller);
  return controller.ExitStatus();
}

int JobState::Compute(const FusionTask& task) {
  const FatalErrors fatal_errors("Fusion failed");
  auto options = MakeOptions<colmap::mvs::StereoFusionOptions>(task.options);
  if (!task.bbox_path.empty()) {
    colmap::Reconstruction model;
    if (task.workspace_format == "colmap") {
      model.Read(colmap::JoinPaths(task.workspace_path, "sparse"));
    }
    options.bounding_box = ReadBoundingBox(task.bbox_path, LocalOrigin(model));
  }
  colmap::mvs::StereoFusion fusion(options, task.workspace_path,
                                   task.workspace_format, task.pmvs_option_name,
                                   task.input_type);
  RunThread(&fusion);
  if (fusion.ExitStatus() == EXIT_SUCCESS) {
    WriteFusedPoints(task.output_path, fusion);
  }
  return fusion.ExitStatus();
}

void JobState::RunThread(colmap::Thread* thread) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    // Before its start a thread cannot be stopped.
    thread->Start();
    if (is_stopped_) {
      thread->Stop();
    }
    computing_ = thread;
  }
  thread->Wait();
  const std::lock_guard<std::mutex> lock(mutex_);
  computing_ = nullptr;
}

void JobState::AddLine(const std::string& line) {
  const std::lock_guard<std::mutex> lock(mutex_);
  lines_.push_back(line);
}

void JobState::AddError(const std::string& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  errors_.push_back(error);
}

void JobState::End(int status, bool is_asleep) {
  // What is printed from now on, by threads that a sleeping one has left, is of
  // no job.
  {
    const std::lock_guard<std::mutex> lock(running_mutex_);
    if (running_.get() != this) {
      return;
    }
    cout_->End();
    cerr_->End();
    running_ = nullptr;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = status;
  is_asleep_ = is_asleep;
  has_ended_ = true;
  end_.notify_all();
}

bool JobState::Wait(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  return end_.wait_for(lock, std::chrono::duration<double>(seconds),
                       [this] { return has_ended_; });
}

void JobState::Stop() {
  std::unique_lock<std::mutex> lock(mutex_);
  is_stopped_ = true;
  if (computing_ != nullptr) {
    computing_->Stop();
  }
  end_.wait(lock, [this] { return has_ended_; });
}

void JobState::Leave() {
  Stop();
  if (!is_asleep_ && thread_.joinable()) {
    thread_.join();
  }
}

std::pair<double, std::string> JobState::Progress() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {share_, text_};
}

std::vector<std::string> JobState::TakeLines() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(lines_, {});
}

bool JobState::IsDone() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return has_ended_ && status_ == EXIT_SUCCESS;
}

std::vector<std::string> JobState::Errors() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return errors_;
}

Job::Job(const StereoTask& task) : state_(std::make_shared<JobState>()) {
  state_->Start(task);
}

Job::Job(const FusionTask& task) : state_(std::make_shared<JobState>()) {
  state_->Start(task);
}

Job::~Job() { state_->Leave(); }

bool Job::Wait(double seconds) { return state_->Wait(seconds); }

void Job::Stop() { state_->Stop(); }

std::pair<double, std::string> Job::Progress() const {
  return state_->Progress();
}

std::vector<std::string> Job::TakeLines() { return state_->TakeLines(); }

bool Job::IsDone() const { return state_->IsDone(); }

std::vector<std::string> Job::Errors() const { return state_->Errors(); }

}  // namespace tapa
