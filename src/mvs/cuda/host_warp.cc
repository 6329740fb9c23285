#include "src/mvs/cuda/host_warp.h"

#include <ucontext.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace tapa {
namespace {

constexpr int kSize = HostWarp::kSize;
constexpr size_t kStackBytes = 256 * 1024;

struct LaneState {
  ucontext_t context;
  std::unique_ptr<char[]> stack;
  bool ended = false;
  // How often the lane has come to a meeting of groups of 2^i lanes.
  std::array<uint64_t, 6> arrivals = {};
  // What it gave to the last two of them: a lane that goes on to the next
  // meeting must not overwrite what another has yet to read.
  std::array<std::array<float, 2>, 6> given = {};
};

struct WarpState {
  std::array<LaneState, kSize> lanes;
  // Lanes in the order of their turns.
  std::array<int, kSize> order;
  ucontext_t scheduler;
  int running = -1;
  const std::function<void()>* body = nullptr;
  std::exception_ptr error;
};

thread_local WarpState* warp = nullptr;

void RunLane() {
  WarpState* const state = warp;
  try {
    (*state->body)();
  } catch (...) {
    if (!state->error) {
      state->error = std::current_exception();
    }
  }
  LaneState& lane = state->lanes[state->running];
  lane.ended = true;
  // Returns to the scheduler through uc_link.
}

void YieldLane() {
  WarpState* const state = warp;
  swapcontext(&state->lanes[state->running].context, &state->scheduler);
}

int Log2(int group_size) {
  int log = 0;
  while ((1 << log) < group_size) {
    ++log;
  }
  return log;
}

// Whether all lanes of the group have come to its meeting number `count`.
bool AllHaveArrived(const WarpState& state, int group_begin, int log,
                    uint64_t count) {
  for (int i = group_begin; i < group_begin + (1 << log); ++i) {
    if (state.lanes[i].arrivals[log] < count) {
      return false;
    }
  }
  return true;
}

void Meet(int log, float value) {
  const int lane = warp->running;
  LaneState& self = warp->lanes[lane];
  const uint64_t count = ++self.arrivals[log];
  self.given[log][count % 2] = value;
  while (!AllHaveArrived(*warp, lane >> log << log, log, count)) {
    YieldLane();
  }
}

uint64_t NumArrivals(const WarpState& state) {
  uint64_t sum = 0;
  for (const LaneState& lane : state.lanes) {
    sum += std::accumulate(lane.arrivals.begin(), lane.arrivals.end(),
                           uint64_t{lane.ended});
  }
  return sum;
}

// Gives every lane a turn. Returns false once all have ended.
bool RunTurns(WarpState* state) {
  bool any = false;
  for (const int lane : state->order) {
    if (!state->lanes[lane].ended && !state->error) {
      any = true;
      state->running = lane;
      swapcontext(&state->scheduler, &state->lanes[lane].context);
    }
  }
  return any;
}

}  // namespace

void HostWarp::Run(const std::function<void()>& body, uint32_t order) {
  const auto state = std::make_unique<WarpState>();
  state->body = &body;
  std::iota(state->order.begin(), state->order.end(), 0);
  if (order != 0) {
    std::shuffle(state->order.begin(), state->order.end(), std::mt19937(order));
  }
  for (LaneState& lane : state->lanes) {
    getcontext(&lane.context);
    lane.stack = std::make_unique<char[]>(kStackBytes);
    lane.context.uc_stack.ss_sp = lane.stack.get();
    lane.context.uc_stack.ss_size = kStackBytes;
    lane.context.uc_link = &state->scheduler;
    makecontext(&lane.context, RunLane, 0);
  }
  warp = state.get();
  uint64_t before = 0;
  while (RunTurns(state.get())) {
    const uint64_t now = NumArrivals(*state);
    if (now == before && !state->error) {
      state->error = std::make_exception_ptr(std::logic_error(
          "lanes wait for one that does not come to where they are"));
    }
    before = now;
  }
  warp = nullptr;
  if (state->error) {
    std::rethrow_exception(state->error);
  }
}

int HostWarp::Lane() { return warp->running; }

void HostWarp::Sync() { Meet(Log2(kSize), 0); }

float HostWarp::Shuffle(float value, int source, int group_size) {
  const int log = Log2(group_size);
  Meet(log, value);
  const LaneState& lane = warp->lanes[source];
  return lane.given[log][warp->lanes[warp->running].arrivals[log] % 2];
}

}  // namespace tapa
