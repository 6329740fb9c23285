#ifndef TAPA_SRC_MVS_CUDA_LANES_H_
#define TAPA_SRC_MVS_CUDA_LANES_H_

#include <cuda_runtime.h>

#include "src/mvs/sweep/host_device.h"
#include "src/mvs/sweep/hypotheses.h"

namespace tapa {

// The 32 lanes of a warp share a pixel (see SerialLanes in sweep/lanes.h).
// Loops over views and over the samples of a patch are shared out among all of
// them; correlations among groups, whose lanes take neighbouring samples, so
// that their texture reads meet in the same lines of the cache.
//
// Only for code of a device; on the host it means nothing.
struct WarpLanes {
  static constexpr int kSize = 32;

  static TAPA_INLINE int First() {
#if defined(TAPA_ON_DEVICE)
    return threadIdx.x % kSize;
#else
    return 0;
#endif
  }
  static constexpr TAPA_INLINE int Step() { return kSize; }

  static TAPA_INLINE void Sync() {
#if defined(TAPA_ON_DEVICE)
    __syncwarp();
#endif
  }

  static TAPA_INLINE float Sum(float value) { return SumOf<kSize>(value); }
  // Exact up to 2^24.
  static TAPA_INLINE int Sum(int value) {
    return static_cast<int>(SumOf<kSize>(static_cast<float>(value)));
  }

  static TAPA_INLINE float Accumulate(int count, float* values) {
    float before = 0.0f;
    for (int begin = 0; begin < count; begin += kSize) {
      const int i = begin + First();
      float sum = i < count ? values[i] : 0.0f;
      for (int distance = 1; distance < kSize; distance *= 2) {
        const int source = First() - distance;
        const float other = FromLane(sum, source < 0 ? First() : source);
        sum += source < 0 ? 0.0f : other;
      }
      sum += before;
      if (i < count) {
        values[i] = sum;
      }
      before = FromLane(sum, kSize - 1);
    }
    Sync();
    return before;
  }

  static constexpr int kGroupSize = 4;
  static constexpr int kNumGroups = kSize / kGroupSize;
  static constexpr int kNumSideBySide = kNumHypotheses - 1;
  // 8, 4, 5, 2, 3, 4, 1: what leaves at most one group of the last round idle,
  // four bits for each number of hypotheses from 1 on.
  static TAPA_INLINE int NumViewsAtOnce(int num_hypotheses) {
    static_assert(kNumGroups == 8 && kNumHypotheses <= 8, "made for that");
    return 0x14325480u >> (4 * num_hypotheses) & 15u;
  }
  static TAPA_INLINE int Group() { return First() / kGroupSize; }
  static TAPA_INLINE int GroupLane() { return First() % kGroupSize; }
  // Of every group its own, but by all of them together.
  static TAPA_INLINE float GroupSum(float value) {
    return SumOf<kGroupSize>(value);
  }

 private:
  static constexpr unsigned kAllLanes = 0xFFFFFFFFu;

  // What another lane gives.
  static TAPA_INLINE float FromLane(float value, int lane) {
#if defined(TAPA_ON_DEVICE)
    return __shfl_sync(kAllLanes, value, lane);
#else
    return lane == 0 ? value : 0.0f;
#endif
  }

  template <int kGroup>
  static TAPA_INLINE float SumOf(float value) {
#if defined(TAPA_ON_DEVICE)
    for (int distance = kGroup / 2; distance > 0; distance /= 2) {
      value += __shfl_xor_sync(kAllLanes, value, distance);
    }
#endif
    return value;
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_LANES_H_
