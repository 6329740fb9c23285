#ifndef TAPA_SRC_MVS_ESTIMATE_DEPTH_H_
#define TAPA_SRC_MVS_ESTIMATE_DEPTH_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "src/base/map.h"
#include "src/base/uninitialized_vector.h"
#include "src/base/vec3.h"
#include "src/mvs/options.h"
#include "src/mvs/view.h"

namespace tapa {

// One reference view and the source views that its pixels are compared with.
struct Problem {
  View reference;
  // At least one. Views may differ in size and camera.
  std::vector<View> sources;
  // Range of the first random depths, in scene units: 0 < min <= max.
  float depth_min = 0;
  float depth_max = 0;
  // The reference photograph in colour, of the same size as its grey image,
  // for TAPA's superpixels; not there: they see the grey image. Borrowed.
  const Map<Rgb>* reference_color = nullptr;
  // Where the geometric pass starts: depth in scene units and unit normals in
  // the reference camera's frame, both of the reference image's size. Pixels
  // whose depth is not positive or whose normal faces away from the camera
  // start at random. Not used by the photometric pass.
  Map<float> depth;
  Map<Vec3> normal;
};

struct Estimate {
  // Depth in scene units, 0 where the estimate was filtered.
  Map<float> depth;
  // Unit normals in the reference camera's frame, 0 where filtered.
  Map<Vec3> normal;
  // Probability that source view m sees a pixel, 0 to 1, at
  // [pixel * sources + m], in fixed point: value / 65535.
  UninitializedVector<uint16_t> selection_prob;
  // With Options::filter or TAPA: bit m % 8 of byte [pixel * ceil(sources / 8)
  // + m / 8] says whether source view m supports the estimate. TAPA's geometric
  // pass looks at depths and angles only, not at selection probabilities.
  std::vector<uint8_t> consistent;
  // With TAPA: the hypothesis (sweep/hypotheses.h) that each pixel chose last.
  Map<uint8_t> chosen;
};

struct TapaRecord;

// How a caller follows and ends a running estimation. Both are called often,
// from the calling thread or another one, never from two at a time.
struct Control {
  // Receives the share of the work that is done, 0 to 1.
  std::function<void(double)> progress;
  // Returns true to end the estimation within a fraction of a second.
  std::function<bool()> stopped;
  // Filled with what TAPA did, if it runs.
  TapaRecord* record = nullptr;
};

// Estimates depth and normal of every pixel of the reference view. Returns
// nothing if control.stopped() said so. Throws std::invalid_argument for
// options or a problem that make no sense, and DeviceError (devices.h) if a GPU
// fails, which the CPU does not. The result depends neither on the
// number of threads nor on what was estimated before. Takes the problem by
// value: move it in where its maps are large.
std::optional<Estimate> EstimateDepth(const Options& options, Problem problem,
                                      const Control& control = Control());

// Bytes of memory that EstimateDepth needs besides the images and depth maps of
// the views. For n source views of w x h pixels:
//
//   w h (16 + 1 + 4 n) for the estimate, the image, the costs and probabilities
//   w h ceil(n / 8)    for Estimate::consistent, with Options::filter or TAPA
//   37 w h             for TAPA
//   2 w h n            for the source images
//
// The views themselves need w h (1 + n) and, in the geometric pass, 4 w h n.
size_t EstimateDepthMemory(const Options& options, const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_ESTIMATE_DEPTH_H_
