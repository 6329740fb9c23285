#ifndef TAPA_SRC_MVS_SWEEP_LANES_H_
#define TAPA_SRC_MVS_SWEEP_LANES_H_

#include "src/mvs/sweep/host_device.h"

// A backend's `Lanes` say how the work for a pixel is shared out; the functions
// that take them run in all lanes together, with the same arguments, and return
// the same results. Lanes share the scratch: what one lane wrote there, others
// may read after Sync().

namespace tapa {

// One lane: everything runs in one thread.
struct SerialLanes {
  // A lane's share of a loop: First(), First() + Step(), ...
  static constexpr TAPA_INLINE int First() { return 0; }
  static constexpr TAPA_INLINE int Step() { return 1; }
  static TAPA_INLINE void Sync() {}
  // Sums over all lanes, and over those of a group (see below).
  static TAPA_INLINE int Sum(int value) { return value; }
  static TAPA_INLINE float Sum(float value) { return value; }
  static TAPA_INLINE float GroupSum(float value) { return value; }
  // Replaces values by their cumulative sums, whose last one is returned.
  static TAPA_INLINE float Accumulate(int count, float* values) {
    float sum = 0.0f;
    for (int i = 0; i < count; ++i) {
      sum += values[i];
      values[i] = sum;
    }
    return sum;
  }

  // Correlations are shared out, too: a group of lanes measures one at a time.
  // All groups do so together, see ShareOfGroup.
  static constexpr int kGroupSize = 1;
  static constexpr int kNumGroups = 1;
  static constexpr TAPA_INLINE int Group() { return 0; }
  static constexpr TAPA_INLINE int GroupLane() { return 0; }
  // How many hypotheses are measured side by side. Side by side they fill the
  // groups, one after the other each knows how good those before were.
  static constexpr int kNumSideBySide = 1;
  // In how many views so many hypotheses are measured before those that cannot
  // win any more drop out.
  static constexpr TAPA_INLINE int NumViewsAtOnce(int /*num_hypotheses*/) {
    return 1;
  }
};

// What a group does of the kNumGroups items of a loop that come next.
struct GroupShare {
  int item;
  // Whether this lane stores the result.
  bool stores;
};

// A group for which none is left repeats the last one, so that all lanes go the
// same way and sum across groups with one instruction.
template <class Lanes>
TAPA_INLINE GroupShare ShareOfGroup(int first, int count) {
  const int item = first + Lanes::Group();
  const bool is_mine = item < count;
  return {is_mine ? item : count - 1, is_mine && Lanes::GroupLane() == 0};
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_LANES_H_
