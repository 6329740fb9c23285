#ifndef TAPA_SRC_MVS_SWEEP_CONSISTENCY_MASK_H_
#define TAPA_SRC_MVS_SWEEP_CONSISTENCY_MASK_H_

#include <cstdint>

#include "src/mvs/sweep/host_device.h"

namespace tapa {

// Which source views are consistent with a pixel's estimate: a bit for each,
// bit m % 8 of byte m / 8 for view m.

TAPA_INLINE int ConsistencyMaskBytes(int num_views) {
  return (num_views + 7) / 8;
}

// The bit of view m in its byte.
TAPA_INLINE uint8_t ConsistencyBit(int m, bool consistent) {
  return static_cast<uint8_t>(static_cast<unsigned>(consistent) << (m % 8));
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_SWEEP_CONSISTENCY_MASK_H_
