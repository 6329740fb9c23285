#ifndef TAPA_SRC_MVS_OPTIONS_H_
#define TAPA_SRC_MVS_OPTIONS_H_

#include <cstdint>
#include <string>

namespace tapa {

// Parameters of one depth map estimation. The defaults are COLMAP's
// (Schoenberger et al., "Pixelwise View Selection for Unstructured Multi-View
// Stereo", ECCV 2016). Angles are in degrees.
struct Options {
  // Half size of the correlation window, in pixels: the window has
  // 2 * window_radius + 1 rows and columns.
  int window_radius = 5;
  // Distance between the samples in the window, in pixels: 1 or 2.
  int window_step = 1;
  // Spread of the bilateral weights over distance in pixels; not positive:
  // window_radius.
  double sigma_spatial = -1;
  // Spread of the bilateral weights over difference in intensity (0 to 1).
  double sigma_color = 0.2;

  // Number of source views drawn with replacement per pixel and sweep.
  int num_samples = 15;
  // Spread of the likelihood of a view's cost (1 - NCC).
  double ncc_sigma = 0.6;
  // Triangulation angle below which a view's prior falls off, in degrees.
  double min_triangulation_angle = 1;
  // Spread of the prior on the cosine of the incident angle.
  double incident_angle_sigma = 0.9;

  // Number of iterations of four sweeps each.
  int num_iterations = 5;

  // Geometric pass: start from the given maps and add the geometric term.
  bool geom_consistency = true;
  // Weight of the geometric term against the photometric one.
  double geom_consistency_regularizer = 0.3;
  // Largest geometric cost: forward-backward reprojection error, in pixels.
  double geom_consistency_max_cost = 3;

  // Whether the last sweep removes estimates that too few views support.
  bool filter = true;
  // A view supports an estimate if its selection probability reaches the
  // likelihood of this correlation (-1 to 1), ...
  double filter_min_ncc = 0.1;
  // ... its triangulation angle reaches this, in degrees, ...
  double filter_min_triangulation_angle = 3;
  // ... and, in the geometric pass, its reprojection error does not exceed
  // this, in pixels.
  double filter_geom_consistency_max_cost = 1;
  // Number of views that have to support an estimate; at most the number of
  // source views is asked for.
  int filter_min_num_consistent = 2;

  // Number of threads of the CPU backend; -1: one per core.
  int num_threads = -1;
  // Key of all random draws. The same seed gives the same maps.
  uint64_t seed = 0;

  // Throws std::invalid_argument that names the option and its valid range.
  void Check() const;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_OPTIONS_H_
