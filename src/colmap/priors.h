#ifndef TAPA_SRC_COLMAP_PRIORS_H_
#define TAPA_SRC_COLMAP_PRIORS_H_

#include <map>
#include <string>
#include <vector>

#include "mvs/model.h"
#include "src/base/map.h"
#include "src/colmap/prior_fit.h"
#include "src/colmap/views.h"

namespace tapa {

// Priors are depth maps from elsewhere: one file per photograph in a folder, in
// one of the formats of src/pictures/depth_files.h, of the photograph's shape
// but of any size and in any unit.

// Path of the prior of an image, named like the image and with an extension of
// its own, in place of the image's or after it, in its sub-folder or without;
// empty if there is none, or if the folder's name is empty.
std::string PriorPath(const std::string& folder, const std::string& image_name);

// A prior that fits the sparse points of its view.
struct FittedPrior {
  std::string path;
  PriorFit fit;
};

// Those of views, indices of the scene's, which are those of the model. Reads
// all files, prints how many there are, and warns of views that have none and
// of those that do not fit. Throws Failure if no view has one, if one would
// serve for two views, is of another shape than its photograph, or if
// ReadDepthFile would throw.
std::map<int, FittedPrior> FitPriors(const std::string& folder,
                                     const colmap::mvs::Model& model,
                                     const std::vector<SceneView>& scene,
                                     const std::vector<int>& views);

// In scene units, 0 where there is none. Throws Failure.
Map<float> ReadPrior(const FittedPrior& prior);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PRIORS_H_
