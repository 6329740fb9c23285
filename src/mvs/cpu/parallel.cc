#include "src/mvs/cpu/parallel.h"

#include <algorithm>
#include <exception>

namespace tapa {

int EffectiveNumThreads(int num_threads) {
  return num_threads > 0
             ? num_threads
             : std::max(1,
                        static_cast<int>(std::thread::hardware_concurrency()));
}

struct ThreadTeam::Loop {
  int count;
  int block_size;
  const std::function<void(int, int, int)>& run;
  const std::function<bool(double)>& more;

  std::mutex mutex;
  int next = 0;
  int done = 0;
  bool stopped = false;
  std::exception_ptr error;
};

ThreadTeam::ThreadTeam(int num_threads) {
  for (int thread = 1; thread < num_threads; ++thread) {
    threads_.emplace_back(&ThreadTeam::Work, this, thread);
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
  std::unique_lock<std::mutex> lock(loop->mutex);
  while (!loop->stopped && loop->next < loop->count) {
    const int begin = loop->next;
    const int end = std::min(loop->count, begin + loop->block_size);
    loop->next = end;
    lock.unlock();
    std::exception_ptr error;
    try {
      loop->run(thread, begin, end);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    loop->done += end - begin;
    if (error) {
      loop->error = error;
      loop->stopped = true;
    } else if (!loop->stopped &&
               !loop->more(static_cast<double>(loop->done) / loop->count)) {
      loop->stopped = true;
    }
  }
}

bool ThreadTeam::For(int count, int block_size,
                     const std::function<void(int, int, int)>& run,
                     const std::function<bool(double)>& more) {
  Loop loop{count, block_size, run, more, {}, 0, 0, false, nullptr};
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
