#ifndef TAPA_SRC_MVS_PLANE_SET_H_
#define TAPA_SRC_MVS_PLANE_SET_H_

#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/mvs/sweep/guide.h"

namespace tapa {

// Planes, one of which every pixel may try as a hypothesis.
struct PlaneSet {
  static constexpr uint16_t kNone = PlaneTable::kNone;

  std::vector<Plane> planes;
  // Which plane each pixel tries; kNone: none. Empty: no pixel tries any.
  Map<uint16_t> index;

  // Points into this set.
  PlaneTable Table() const {
    return index.empty() ? PlaneTable()
                         : PlaneTable{planes.data(), index.data()};
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_PLANE_SET_H_
