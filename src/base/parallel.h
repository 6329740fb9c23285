#ifndef TAPA_SRC_BASE_PARALLEL_H_
#define TAPA_SRC_BASE_PARALLEL_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "src/base/progress.h"

namespace tapa {

// num_threads, if <= 0 the number of cores.
int EffectiveNumThreads(int num_threads);

// Threads that share out ranges of indices. The calling thread is one of them.
class ThreadTeam {
 public:
  // Works on the indices [begin, end): run(thread, begin, end,
  // should_continue).
  using Block = std::function<void(int, int, int, const ContinueCheck&)>;

  // Makes do with fewer threads where the system does not give that many.
  explicit ThreadTeam(int num_threads);
  ~ThreadTeam();

  int size() const { return static_cast<int>(threads_.size()) + 1; }

  // Calls `run` for blocks of at most block_size indices that together cover
  // [0, count), each thread one block at a time, and returns when all are done.
  // After every block, and whenever `run` calls should_continue(), it calls
  // `progress` from one thread at a time; once that returns false, no further
  // block is started, and should_continue() returns false, upon which `run`
  // should return. Returns whether all blocks ran. An exception in `run` or
  // `progress` ends the rest and is thrown here.
  bool For(int count, int block_size, const Block& run,
           const ProgressCallback& progress);

 private:
  struct Loop;

  void Work(int thread);
  void RunBlocks(Loop* loop, int thread);

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Loop* loop_ = nullptr;
  uint64_t num_loops_ = 0;
  int num_busy_ = 0;
  bool quit_ = false;
};

}  // namespace tapa

#endif  // TAPA_SRC_BASE_PARALLEL_H_
