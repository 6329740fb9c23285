#ifndef TAPA_SRC_FUSION_VIEW_ORDER_H_
#define TAPA_SRC_FUSION_VIEW_ORDER_H_

#include <vector>

namespace tapa {

// An order of all views in which each follows, where possible, one that it is a
// neighbour of, so that maps are read seldom. neighbors: of each view, the best
// first.
std::vector<int> ViewOrder(const std::vector<std::vector<int>>& neighbors);

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_VIEW_ORDER_H_
