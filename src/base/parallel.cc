#include "src/base/parallel.h"

#include <algorithm>
#include <exception>
#include <system_error>

#include "src/base/machine_limits.h"

namespace tapa {

int EffectiveNumThreads(int num_threads) {
  return num_threads > 0 ? num_threads : FindMachineLimits().num_cpus;
}

struct ThreadTeam::Loop {
  const int count;
  const int block_size;
  const Block& run;
  const ProgressCallback& progress;

  std::mutex mutex;
  int next = 0;
  int done = 0;
  bool stopped = false;
  std::exception_ptr error;

  // Both with the mutex held.
  void Fail() {
    error = std::current_exception();
    stopped = true;
  }

  bool ReportProgress() {
    try {
      stopped = stopped || !progress(static_cast<double>(done) / count);
    } catch (...) {
      Fail();
    }
    return !stopped;
  }
};

ThreadTeam::ThreadTeam(int num_threads) {
  for (int thread = 1; thread < num_threads; ++thread) {
    try {
      threads_.emplace_back(&ThreadTeam::Work, this, thread);
    } catch (const std::system_error&) {
      break;
    }
  }
}

ThreadTeam::~ThreadTeam() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    quit_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void ThreadTeam::Work(int thread) {
  uint64_t num_seen = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return quit_ || num_loops_ != num_seen; });
    if (quit_) {
      return;
    }
    num_seen = num_loops_;
    Loop* loop = loop_;
    lock.unlock();
    RunBlocks(loop, thread);
    lock.lock();
    if (--num_busy_ == 0) {
      changed_.notify_all();
    }
  }
}

void ThreadTeam::RunBlocks(Loop* loop, int thread) {
  const ContinueCheck should_continue = [loop] {
    std::lock_guard<std::mutex> lock(loop->mutex);
    return loop->ReportProgress();
  };
  std::unique_lock<std::mutex> lock(loop->mutex);
  while (!loop->stopped && loop->next < loop->count) {
    const int begin = loop->next;
    const int end = std::min(loop->count, begin + loop->block_size);
    loop->next = end;
    lock.unlock();
    try {
      loop->run(thread, begin, end, should_continue);
      lock.lock();
    } catch (...) {
      lock.lock();
      loop->Fail();
    }
    // A block during which the loop was stopped may not be complete.
    if (!loop->stopped) {
      loop->done += end - begin;
      loop->ReportProgress();
    }
  }
}

bool ThreadTeam::For(int count, int block_size, const Block& run,
                     const ProgressCallback& progress) {
  Loop loop{count, block_size, run, progress, {}, 0, 0, false, nullptr};
  {
    std::lock_guard<std::mutex> lock(mutex_);
    loop_ = &loop;
    ++num_loops_;
    num_busy_ = static_cast<int>(threads_.size());
  }
  changed_.notify_all();
  RunBlocks(&loop, 0);
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return num_busy_ == 0; });
  }
  if (loop.error) {
    std::rethrow_exception(loop.error);
  }
  return loop.done == count;
}

}  // namespace tapa
