#ifndef TAPA_SRC_MVS_OPTIONS_H_
#define TAPA_SRC_MVS_OPTIONS_H_

#include <cstdint>
#include <string>

namespace tapa {

// Parameters of TAPA: Romanoni and Matteucci, "TAPA-MVS: Textureless-Aware
// PAtchMatch Multi-View Stereo", ICCV 2019. The defaults are the paper's where
// it gives a value.
struct TapaOptions {
  // Whether TAPA runs at all. The parts below do nothing without it.
  bool enabled = false;

  // Weigh costs by textureness (section 4.2).
  bool texture_weighting = true;
  // Hypotheses from planes fitted to superpixels, fine and coarse ones
  // (section 4.1).
  bool fine_superpixels = true;
  bool coarse_superpixels = true;
  // Remove speckles and fill gaps (section 5) instead of COLMAP's filter.
  bool refinement = true;

  // Variance of intensities (0 to 1) that counts as little texture.
  double textureness_variance = 0.00005;
  // Textureness t of a flat patch, above 0 and at most 1. Where t is below 0.5
  // the weights favour planes. The paper's value is 0.5, with which they never
  // do (docs/tapa.md).
  double min_textureness = 0.1;
  // By how much textureness changes the weights: w+ = 1 - range (1 - t),
  // w- = 1 - range t. 0 to 1.
  double weight_range = 0.2;

  // Number of superpixels: image width / divisor.
  double fine_divisor = 20;
  double coarse_divisor = 30;
  // Largest distance of a point from its superpixel's plane, in scene units;
  // not positive: relative_plane_distance decides.
  double plane_distance = -1;
  // The same as a share of the superpixel's median depth.
  double relative_plane_distance = 0.01;

  // Connected regions of at most this share of the image are speckles.
  double speckle_size = 0.0002;
  // Neighbouring pixels are connected if their depths differ by at most this
  // share of the scene's size, depth_max - depth_min.
  double speckle_continuity = 0.1;
  // Half size of the window that a missing pixel is filled from, in pixels.
  int fill_radius = 5;
  // How often the fill is repeated: it reaches fill_radius pixels each time.
  int fill_rounds = 1;

  // Beyond the paper: only estimates stay that source views support, one view
  // fewer than Options::filter_min_num_consistent but at least one. Planes of
  // superpixels, fitted to those that reach that number, replace the others
  // (docs/tapa.md).
  bool completion = true;
  // Share of the estimates nearby that have to lie on the plane, 0 to 1.
  double completion_agreement = 0.5;
  // What is nearby: half size of a square, as a share of the image's width.
  double completion_radius = 0.1;
  // Below this textureness planes replace estimates that are supported but not
  // by that number of views, too.
  double completion_textureness = 0.5;
  // Share of a window's pixels that have to speak for the fill of a missing
  // one, 0 to 1. Without completion any will do, as in the paper.
  double completion_fill_share = 0.5;

  // Throws std::invalid_argument that names the option, with the prefix tapa_,
  // and its valid range.
  void Check() const;
};

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

  TapaOptions tapa;

  // Number of the GPU that computes, as in devices.h; -1: the CPU does.
  int device = -1;
  // Number of threads of the CPU backend; -1: one per core.
  int num_threads = -1;
  // Key of all random draws. The same seed gives the same maps.
  uint64_t seed = 0;

  // Throws std::invalid_argument that names the option and its valid range.
  void Check() const;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_OPTIONS_H_
