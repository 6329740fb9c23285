#ifndef TAPA_SRC_MVS_TAPA_TEXTURENESS_H_
#define TAPA_SRC_MVS_TAPA_TEXTURENESS_H_

#include <cstdint>

#include "src/base/map.h"
#include "src/mvs/options.h"

namespace tapa {

// The values of Romanoni and Matteucci, "TAPA-MVS: Textureless-Aware PAtchMatch
// Multi-View Stereo", ICCV 2019, section "Textureness-Aware Hypotheses
// Integration": scores by textureness use them. The engine has values of its
// own, in TapaOptions.
struct TexturenessOptions {
  // Half size of the patch, in pixels: 2 is a patch of 5x5 pixels.
  int radius = 2;
  // Variance of intensities (0 to 1) that counts as little texture.
  double epsilon = 0.00005;
  // Textureness of a patch without any variance.
  double min_textureness = 0.5;
};

// Above this a pixel has texture for silhouettes and regions. Not an option,
// for with those of completion at values at which they decide nothing these
// would end, too.
constexpr float kTextured = 0.5f;

// Those of a run.
TexturenessOptions TexturenessOf(const TapaOptions& options);

// Textureness of every pixel of a grey image (0 to 255),
//
//   t = (Var + epsilon) / (Var + epsilon / min_textureness),
//
// where Var is the population variance of the intensities, scaled to 0 to 1, in
// the patch around the pixel. It is min_textureness where the patch is flat and
// tends to 1 with growing variance. At the border the patch consists of those
// of its pixels that lie in the image. An empty image gives an empty map.
// Throws std::invalid_argument unless 0 <= radius <= 1000, epsilon > 0 and
// 0 < min_textureness <= 1. The time does not depend on the radius.
Map<float> ComputeTextureness(
    const Map<uint8_t>& image,
    const TexturenessOptions& options = TexturenessOptions());

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_TEXTURENESS_H_
