#ifndef TAPA_SRC_PICTURES_TAPA_PICTURES_H_
#define TAPA_SRC_PICTURES_TAPA_PICTURES_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/base/vec3.h"
#include "src/mvs/tapa/stages.h"

namespace tapa {

// A view that TAPA ran on. Everything is borrowed, and all maps have the size
// of the photograph.
struct TapaView {
  // Of the legend.
  std::string title;
  const Map<Rgb>* photograph = nullptr;
  const TapaRecord* record = nullptr;
  // The final estimate.
  const Map<float>* depth = nullptr;
  const Map<Vec3>* normal = nullptr;
  // Textureness of a patch without any variance.
  float min_textureness = 0.5f;
};

struct NamedPicture {
  // One of TapaPictureNames.
  std::string name;
  // 8 bits; blue, green, red.
  cv::Mat image;
};

// The names of all pictures that there can be, in their order.
const std::vector<std::string>& TapaPictureNames();

// Draws what TAPA did with a view:
//
//   00_legend             what the colours mean, in numbers of this view
//   01_photograph
//   02_textureness        black: that of a flat patch; white: 1
//   03_fine_superpixels   their borders on the photograph
//   04_coarse_superpixels
//   05_fine_planes        the colour of the plane's normal (color_map.h), as
//   06_coarse_planes      bright as its inlier ratio, which is also written
//                         down in %; black: no plane
//   07_chosen_hypotheses  of the last sweep, by HypothesisColor; black: masked
//   08_swept_depth        after the last sweep
//   09_filtered_depth     without unsupported estimates and speckles
//   10_plane_agreement    of the best plane nearby; black: 0, white: 1
//   11_origin             where the final depth comes from, by OriginColor
//   12_final_depth
//   13_final_normals
//
// Depths share the colours of the range of view.depth. All but the legend have
// the size of the photograph, pixel by pixel. Those of parts that were off are
// left out. Throws std::invalid_argument if parts are missing that must be
// there, or differ in size.
std::vector<NamedPicture> DrawTapaPictures(const TapaView& view);

// The last two of them anew, for an estimate that other views had a say in
// (tapa/consensus.h), in the colours of what it was before.
std::vector<NamedPicture> DrawFinalPictures(const Map<float>& before,
                                            const Map<float>& depth,
                                            const Map<Vec3>& normal);

// The colour of a hypothesis (Hypothesis in sweep/hypotheses.h).
cv::Vec3b HypothesisColor(int hypothesis);

// The colour of an origin (Origin in completion.h).
cv::Vec3b OriginColor(int origin);

inline const cv::Vec3b kBorderColor(0, 255, 255);

}  // namespace tapa

#endif  // TAPA_SRC_PICTURES_TAPA_PICTURES_H_
