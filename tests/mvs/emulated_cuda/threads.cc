#include "tests/mvs/emulated_cuda/threads.h"

#include <sanitizer/asan_interface.h>

#include <algorithm>
#include <array>
#include <boost/context/fiber.hpp>
#include <boost/context/pooled_fixedsize_stack.hpp>
#include <exception>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

thread_local dim3 threadIdx;
thread_local dim3 blockIdx;
thread_local dim3 blockDim;

namespace tapa {

// See cuda_runtime.h.
alignas(16) float shared_words[emulated_cuda::kMaxSharedBytes / sizeof(float)];

}  // namespace tapa

namespace emulated_cuda {
namespace {

using boost::context::fiber;

// Threads meet in aligned groups of 2^i lanes, and as a whole block.
constexpr int kBlockLevel = 6;
constexpr int kNumLevels = kBlockLevel + 1;

// What a thread came to a meeting for, 0 and more being kinds of shuffles, and
// with.
constexpr int kSync = -1;
struct Arrival {
  int what;
  uint32_t value;
};

struct Thread {
  fiber fiber_of_thread;
  bool ended = false;
  // The meeting that it waits at, -1: none.
  int waits_at = -1;
  // How often it has come to the meetings of a level.
  std::array<uint64_t, kNumLevels> count = {};
  // The last two times: a thread that goes on to the next meeting must not
  // overwrite what another has yet to read.
  std::array<std::array<Arrival, 2>, kNumLevels> arrivals = {};
};

struct Block {
  std::vector<Thread> threads;
  int running = -1;
  fiber scheduler;
  std::exception_ptr error;

  Thread& self() { return threads[running]; }
};

thread_local Block* current = nullptr;

// The threads [begin, end) that a thread meets.
std::pair<int, int> Group(const Block& block, int thread, int level) {
  if (level == kBlockLevel) {
    return {0, static_cast<int>(block.threads.size())};
  }
  const int begin = thread >> level << level;
  return {begin, begin + (1 << level)};
}

bool AllHaveArrived(const Block& block, int thread, int level) {
  const auto [begin, end] = Group(block, thread, level);
  const uint64_t count = block.threads[thread].count[level];
  for (int i = begin; i < end; ++i) {
    if (block.threads[i].count[level] < count) {
      return false;
    }
  }
  return true;
}

// Waits for the others of the group; the values that they came with are in
// their arrivals with the returned index.
int Meet(int level, int what, uint32_t value) {
  Block* const block = current;
  const int thread = block->running;
  const int slot = ++block->self().count[level] % 2;
  block->self().arrivals[level][slot] = {what, value};
  if (!AllHaveArrived(*block, thread, level)) {
    block->self().waits_at = level;
    block->scheduler = std::move(block->scheduler).resume();
    block->self().waits_at = -1;
  }
  const auto [begin, end] = Group(*block, thread, level);
  for (int i = begin; i < end; ++i) {
    if (block->threads[i].arrivals[level][slot].what != what) {
      throw std::logic_error("threads meet for different operations");
    }
  }
  return slot;
}

int LevelOf(unsigned mask) {
  const int lane = current->running % kWarpSize;
  for (int level = 0; level < kBlockLevel; ++level) {
    const uint64_t group = ((uint64_t{1} << (1 << level)) - 1)
                           << (lane >> level << level);
    if (mask == group) {
      return level;
    }
  }
  throw std::logic_error("lane " + std::to_string(lane) +
                         " waits with a mask that is no group of its own");
}

constexpr size_t kStackBytes = 128 * 1024;

// AddressSanitizer marks the surroundings of variables. Of frames that an
// exception leaves behind it takes the marks away on stacks of threads only,
// and whoever runs there next would stumble over them. Does so from the frame
// of a fiber's first function on.
void ForgetFramesBelow([[maybe_unused]] char* frame) {
  // That function's own frame and what Boost has above it are less.
  constexpr size_t kAbove = 8 * 1024;
  ASAN_UNPOISON_MEMORY_REGION(frame - (kStackBytes - kAbove),
                              kStackBytes - kAbove);
}

fiber MakeFiber(Block* block, const std::function<void()>& body) {
  // One pool of stacks for all blocks.
  static thread_local boost::context::pooled_fixedsize_stack stacks(
      kStackBytes);
  return fiber(std::allocator_arg, stacks, [block, &body](fiber&& scheduler) {
    char* const frame = static_cast<char*>(__builtin_frame_address(0));
    ForgetFramesBelow(frame);
    block->scheduler = std::move(scheduler);
    try {
      body();
    } catch (const boost::context::detail::forced_unwind&) {
      ForgetFramesBelow(frame);
      throw;
    } catch (...) {
      block->error = std::current_exception();
    }
    block->self().ended = true;
    return std::move(block->scheduler);
  });
}

// Gives every thread that can go on a turn. Returns whether there was any.
bool RunTurns(Block* block, const std::vector<int>& order) {
  bool any = false;
  for (const int i : order) {
    Thread& thread = block->threads[i];
    if (thread.ended ||
        (thread.waits_at >= 0 && !AllHaveArrived(*block, i, thread.waits_at))) {
      continue;
    }
    any = true;
    block->running = i;
    threadIdx.x = i;
    thread.fiber_of_thread = std::move(thread.fiber_of_thread).resume();
    if (block->error) {
      std::rethrow_exception(block->error);
    }
  }
  return any;
}

// Writes where the block must not: the rest of the shared memory.
class SharedMemory {
 public:
  explicit SharedMemory(size_t bytes) : used_((bytes + 3) / 4) {
    std::fill(std::begin(tapa::shared_words), End(), NAN);
  }

  void CheckRest() const {
    if (!std::all_of(std::begin(tapa::shared_words) + used_, End(),
                     [](float word) { return word != word; })) {
      throw std::logic_error("a write beyond the end of shared memory");
    }
  }

 private:
  // Far enough for what a mistake would touch.
  float* End() const {
    const size_t size = std::size(tapa::shared_words);
    return tapa::shared_words + std::min(size, used_ + 4096);
  }

  const size_t used_;
};

}  // namespace

void RunBlock(unsigned block_index, unsigned num_threads, size_t shared_bytes,
              uint32_t turns, const std::function<void()>& body) {
  const SharedMemory shared(shared_bytes);
  blockIdx = block_index;
  blockDim = num_threads;
  Block block;
  block.threads.resize(num_threads);
  for (Thread& thread : block.threads) {
    thread.fiber_of_thread = MakeFiber(&block, body);
  }
  std::vector<int> order(num_threads);
  std::iota(order.begin(), order.end(), 0);
  if (turns != 0) {
    std::shuffle(order.begin(), order.end(),
                 std::mt19937(turns + 1000003 * block_index));
  }
  current = &block;
  while (RunTurns(&block, order)) {
  }
  for (const Thread& thread : block.threads) {
    if (!thread.ended) {
      throw std::logic_error(
          "threads wait for one that does not come to where they are");
    }
  }
  shared.CheckRest();
}

void RunWarp(uint32_t turns, const std::function<void()>& body) {
  RunBlock(0, kWarpSize, 0, turns, body);
}

void SyncBlock() { Meet(kBlockLevel, kSync, 0); }

void SyncLanes(unsigned mask) { Meet(LevelOf(mask), kSync, 0); }

uint32_t Shuffle(unsigned mask, uint32_t value, int source, int what) {
  if (source < 0 || source >= kWarpSize || !(mask >> source & 1)) {
    throw std::logic_error("a lane asks for the value of one that gives none");
  }
  const int level = LevelOf(mask);
  const int slot = Meet(level, what, value);
  const int warp_begin = current->running / kWarpSize * kWarpSize;
  return current->threads[warp_begin + source].arrivals[level][slot].value;
}

}  // namespace emulated_cuda
