#include "src/eval/voxel_average.h"

#include <algorithm>
#include <cmath>

#include "src/eval/parallel_for.h"

namespace tapa {
namespace {

constexpr float kGridShifts[] = {0.0f, 0.5f};
constexpr size_t kNumGrids = 2;

// The cubes of a grid are dealt out to this many parts, each of which one
// thread sorts: with the memory of one part instead of that of a hash table.
constexpr size_t kNumParts = 16;

// A point and the cube that it is in.
struct Entry {
  int32_t x;
  int32_t y;
  int32_t z;
  Verdict verdict;
};

int32_t Cell(float coordinate, float inverse_size, float shift) {
  constexpr float kMax = 2e9f;
  const float cell = std::floor(coordinate * inverse_size + shift);
  return static_cast<int32_t>(std::clamp(cell, -kMax, kMax));
}

// Neighbouring cubes go to different parts.
size_t Part(const Entry& entry) {
  const uint64_t mixed = static_cast<uint32_t>(entry.x) * 73856093ull ^
                         static_cast<uint32_t>(entry.y) * 19349663ull ^
                         static_cast<uint32_t>(entry.z) * 83492791ull;
  return static_cast<size_t>((mixed * 0x9E3779B97F4A7C15ull) >> 32) % kNumParts;
}

bool SameCube(const Entry& a, const Entry& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool CubeLess(const Entry& a, const Entry& b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}

std::vector<Entry> CollectPart(const std::vector<Vec3>& points,
                               const std::vector<Verdict>& verdicts,
                               float inverse_size, float shift, size_t part) {
  std::vector<Entry> entries;
  entries.reserve(points.size() / kNumParts + points.size() / 100);
  for (size_t i = 0; i < points.size(); ++i) {
    const Entry entry = {Cell(points[i].x, inverse_size, shift),
                         Cell(points[i].y, inverse_size, shift),
                         Cell(points[i].z, inverse_size, shift), verdicts[i]};
    if (Part(entry) == part) entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), CubeLess);
  return entries;
}

// Over a number of cubes, for each tolerance.
struct CubeSums {
  explicit CubeSums(size_t num_tolerances)
      : shares(num_tolerances, 0), num_cubes(num_tolerances, 0) {}

  // Of the shares of good points.
  std::vector<double> shares;
  // Cubes with judged points.
  std::vector<int64_t> num_cubes;
};

CubeSums SumOverCubes(const std::vector<Entry>& entries,
                      size_t num_tolerances) {
  CubeSums sums(num_tolerances);
  std::vector<int64_t> num_good(num_tolerances);
  std::vector<int64_t> num_bad(num_tolerances);
  for (size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    std::fill(num_good.begin(), num_good.end(), 0);
    std::fill(num_bad.begin(), num_bad.end(), 0);
    for (; end < entries.size() && SameCube(entries[begin], entries[end]);
         ++end) {
      for (size_t t = 0; t < num_tolerances; ++t) {
        num_good[t] += entries[end].verdict.GoodAt(t);
        num_bad[t] += entries[end].verdict.BadAt(t);
      }
    }
    for (size_t t = 0; t < num_tolerances; ++t) {
      const int64_t num_judged = num_good[t] + num_bad[t];
      if (num_judged == 0) continue;
      sums.shares[t] += static_cast<double>(num_good[t]) / num_judged;
      ++sums.num_cubes[t];
    }
  }
  return sums;
}

}  // namespace

std::vector<double> AverageOverVoxels(const std::vector<Vec3>& points,
                                      const std::vector<Verdict>& verdicts,
                                      size_t num_tolerances, double voxel_size,
                                      ThreadTeam* team) {
  const auto inverse_size = static_cast<float>(1 / voxel_size);
  std::vector<CubeSums> sums(kNumGrids * kNumParts, CubeSums(num_tolerances));
  ParallelFor(sums.size(), 1, team, [&](int, size_t i) {
    const std::vector<Entry> entries =
        CollectPart(points, verdicts, inverse_size, kGridShifts[i / kNumParts],
                    i % kNumParts);
    sums[i] = SumOverCubes(entries, num_tolerances);
  });

  // In the same order for any number of threads, as rounding depends on it.
  std::vector<double> average(num_tolerances, 0);
  for (size_t t = 0; t < num_tolerances; ++t) {
    double share = 0;
    int64_t num_cubes = 0;
    for (const CubeSums& part : sums) {
      share += part.shares[t];
      num_cubes += part.num_cubes[t];
    }
    if (num_cubes > 0) average[t] = share / static_cast<double>(num_cubes);
  }
  return average;
}

}  // namespace tapa
