#ifndef TAPA_SRC_COLMAP_PROBLEM_CONFIG_H_
#define TAPA_SRC_COLMAP_PROBLEM_CONFIG_H_

#include <functional>
#include <string>
#include <vector>

#include "mvs/model.h"

namespace tapa {

// What patch-match.cfg says of one reference view.
struct ViewConfig {
  enum class Sources {
    // "__all__": every other view.
    kAll,
    // "__auto__, N": the N views that share the most points with it. Where the
    // model has no points, those whose cameras stand near and look alike.
    kAuto,
    // "a.jpg, b.jpg"
    kNamed,
  };

  std::string reference;
  Sources sources = Sources::kAll;
  // With kAuto: at least 1.
  int max_num_sources = 0;
  // With kNamed: at least one.
  std::vector<std::string> source_names;
};

// Whether the model has an image of a name.
using IsName = std::function<bool(const std::string&)>;

// Reads pairs of lines: the name of a reference view, then its sources. Empty
// lines and those that begin with # do not count, unless they are the name of
// an image; names may have the commas and semicolons that stand between names.
// Throws Failure for a file that is not there or makes no sense.
std::vector<ViewConfig> ReadProblemConfig(const std::string& path,
                                          const IsName& is_name);

// A reference view and its sources, as indices into the model's images.
struct ViewIndices {
  int reference = -1;
  // In the order of the configuration, or that of the number of shared points;
  // neither twice nor the reference itself. May be empty.
  std::vector<int> sources;
};

// Finds the images that the configuration is about. A view that is listed twice
// counts once. min_triangulation_angle: in degrees; "__auto__" passes over
// views with smaller angles. Throws Failure for names that the model does not
// have.
std::vector<ViewIndices> ResolveProblems(const std::vector<ViewConfig>& config,
                                         const colmap::mvs::Model& model,
                                         double min_triangulation_angle);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROBLEM_CONFIG_H_
