#ifndef TAPA_SRC_MVS_CUDA_HOST_WARP_H_
#define TAPA_SRC_MVS_CUDA_HOST_WARP_H_

#include <cstdint>
#include <functional>

namespace tapa {

// A warp of a GPU on the CPU, for tests: 32 lanes run the same code in turns,
// each until it waits for others. Finds what would hang or be undefined on a
// GPU: a lane that does not come to where the others wait. The order in which
// lanes take turns can be varied, so that a missing Sync() shows as a result
// that depends on it.
class HostWarp {
 public:
  static constexpr int kSize = 32;

  // Runs body() in all lanes. order: key of the order in which they take
  // turns, 0: ascending. Throws std::logic_error if lanes wait for one that
  // has ended or waits elsewhere; exceptions of body() are thrown here. Not to
  // be called from within body().
  static void Run(const std::function<void()>& body, uint32_t order = 0);

  // For body(): the number of the lane that runs.
  static int Lane();
  // Waits for all lanes.
  static void Sync();
  // Waits for all lanes of the group, aligned groups of `group_size` lanes, and
  // returns what lane `source`, one of them, gave.
  static float Shuffle(float value, int source, int group_size);
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_HOST_WARP_H_
