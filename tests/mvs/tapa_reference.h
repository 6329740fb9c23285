#ifndef TAPA_TESTS_MVS_TAPA_REFERENCE_H_
#define TAPA_TESTS_MVS_TAPA_REFERENCE_H_

#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/mvs/sweep/plane.h"
#include "src/mvs/tapa/fill.h"
#include "src/mvs/tapa/speckles.h"
#include "src/mvs/tapa/superpixels.h"
#include "src/mvs/tapa/textureness.h"

// TAPA's stages once more, word by word after their definitions, in double
// precision and without sharing code with them: what tests compare them with,
// and benchmarks measure them against.
namespace tapa::reference {

// Textureness of one pixel, with two passes over its patch.
double Textureness(const Map<uint8_t>& image, int row, int col,
                   const TexturenessOptions& options);

// Flood fill from every pixel that none has reached yet.
void RemoveSpeckles(const Continuity& continuity, int max_size,
                    Map<float>* depth);

// Scans the whole image for every pair of superpixels.
std::vector<std::vector<Neighbor>> FindNeighbors(const Map<Rgb>& image,
                                                 const Map<uint16_t>& labels,
                                                 int count);

// Points X with Dot(normal, X) = -distance, as Plane.
struct DoublePlane {
  double normal[3] = {0, 0, 0};
  double distance = 0;
};

double DistanceTo(const DoublePlane& plane, const Vec3& point);

// Least squares of orthogonal distances, by a singular value decomposition.
DoublePlane FitLeastSquares(const std::vector<Vec3>& points);

// Largest number of points within max_distance of a plane through any three of
// them: what RANSAC approximates. Takes cubic time and more.
int MaxNumInliers(const std::vector<Vec3>& points, double max_distance);

void FillMissing(const FillOptions& options, const RefCamera& camera,
                 const Map<uint8_t>& image, Map<float>* depth,
                 Map<Vec3>* normal);

}  // namespace tapa::reference

#endif  // TAPA_TESTS_MVS_TAPA_REFERENCE_H_
