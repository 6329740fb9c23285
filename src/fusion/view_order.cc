#include "src/fusion/view_order.h"

#include <algorithm>

namespace tapa {

std::vector<int> ViewOrder(const std::vector<std::vector<int>>& neighbors) {
  const int count = static_cast<int>(neighbors.size());
  std::vector<char> is_done(count);
  std::vector<int> order;
  int first_open = 0;
  while (static_cast<int>(order.size()) < count) {
    int next = -1;
    if (!order.empty()) {
      const auto& near = neighbors[order.back()];
      const auto found = std::find_if(near.begin(), near.end(),
                                      [&](int view) { return !is_done[view]; });
      next = found == near.end() ? -1 : *found;
    }
    if (next < 0) {
      while (is_done[first_open]) {
        ++first_open;
      }
      next = first_open;
    }
    is_done[next] = true;
    order.push_back(next);
  }
  return order;
}

}  // namespace tapa
