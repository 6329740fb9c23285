#include "src/mvs/tapa/anchor_votes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tapa {
namespace {

void SortAndUnify(std::vector<int>* numbers) {
  std::sort(numbers->begin(), numbers->end());
  numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
}

// Each anchor and those that share a triangle with it.
std::vector<std::vector<int>> FindNeighbors(const TrianglePlanes& triangles) {
  std::vector<std::vector<int>> neighbors(triangles.anchors.size());
  for (const std::array<int, 3>& corners : triangles.corners) {
    for (const int corner : corners) {
      neighbors[corner].insert(neighbors[corner].end(), corners.begin(),
                               corners.end());
    }
  }
  return neighbors;
}

}  // namespace

AnchorVotes::AnchorVotes(const TrianglePlanes& triangles, double tolerance)
    : triangles_(triangles), tolerance_(static_cast<float>(tolerance)) {
  const std::vector<std::vector<int>> neighbors = FindNeighbors(triangles);
  around_.reserve(triangles.corners.size());
  for (const std::array<int, 3>& corners : triangles.corners) {
    std::vector<int> around;
    for (const int corner : corners) {
      around.insert(around.end(), neighbors[corner].begin(),
                    neighbors[corner].end());
    }
    SortAndUnify(&around);
    around_.push_back(std::move(around));
  }
}

int AnchorVotes::Count(int triangle, const Plane& plane) const {
  int count = 0;
  for (const int anchor : around_[triangle]) {
    // The plane's depth on the anchor's ray, relative to the anchor's.
    const float depth =
        -plane.distance / Dot(plane.normal, triangles_.anchors[anchor]);
    count += std::abs(depth - 1) <= tolerance_ ? 1 : 0;
  }
  return count;
}

}  // namespace tapa
