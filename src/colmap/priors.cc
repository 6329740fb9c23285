#include "src/colmap/priors.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "src/base/depth.h"
#include "src/base/failure.h"
#include "src/colmap/progress.h"
#include "src/pictures/depth_files.h"
#include "util/misc.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

// A sparse point as a view sees it: where, as shares of the image's width and
// height, and its depth in scene units.
struct SeenPoint {
  double x;
  double y;
  double depth;
};

// By view.
std::map<int, std::vector<SeenPoint>> SeenPoints(
    const colmap::mvs::Model& model, const std::vector<SceneView>& scene) {
  std::map<int, std::vector<SeenPoint>> seen;
  for (const auto& point : model.points) {
    for (const int index : point.track) {
      const SceneView& view = scene[index];
      const Camera& camera = view.camera;
      double at[3];
      for (int i = 0; i < 3; ++i) {
        at[i] = camera.R[3 * i] * point.x + camera.R[3 * i + 1] * point.y +
                camera.R[3 * i + 2] * point.z + camera.t[i];
      }
      seen[index].push_back(
          {(camera.fx * at[0] / at[2] + camera.cx) / view.width,
           (camera.fy * at[1] / at[2] + camera.cy) / view.height, at[2]});
    }
  }
  return seen;
}

std::vector<PriorSample> SamplesAt(const std::vector<SeenPoint>& points,
                                   const Map<float>& prior) {
  std::vector<PriorSample> samples;
  for (const SeenPoint& point : points) {
    const double col = std::floor(point.x * prior.width());
    const double row = std::floor(point.y * prior.height());
    if (point.depth > 0 && col >= 0 && row >= 0 && col < prior.width() &&
        row < prior.height()) {
      const float value =
          prior.At(static_cast<int>(row), static_cast<int>(col));
      if (IsDepth(value)) {
        samples.push_back({value, point.depth, point.x, point.y});
      }
    }
  }
  return samples;
}

Map<float> ReadPriorOf(const SceneView& view, const std::string& path) {
  return ReadDepthFile(path, [&](int width, int height) {
    CheckShapeOfPhoto("The depth map " + path, width, height, view.photo_width,
                      view.photo_height,
                      "make it of the photograph in the workspace");
  });
}

// Warns, and returns nothing, if it does not fit.
std::optional<FittedPrior> FitOne(const SceneView& view,
                                  const std::string& path,
                                  const std::vector<SeenPoint>& points) {
  const std::vector<PriorSample> samples =
      SamplesAt(points, ReadPriorOf(view, path));
  const PriorFit fit = FitPrior(samples);
  if (fit.IsGood()) {
    return FittedPrior{path, fit};
  }
  const std::string num_samples = std::to_string(samples.size());
  PrintWarning(
      "The depth map " + path +
      (samples.size() < kMinPriorSamples
           ? " cannot be fitted: it has values at " + num_samples +
                 " sparse points of its view, and " +
                 std::to_string(kMinPriorSamples) + " are needed"
           : " does not fit: " + std::to_string(std::lround(100 * fit.share)) +
                 " % of the " + num_samples +
                 " sparse points of its view lie on it, whatever its scale and "
                 "shift, and 80 % are needed") +
      "; the view is computed without it");
  return std::nullopt;
}

// Nobody names a folder of priors to have none: without an error, hours would
// be spent because of a name that is spelt wrong.
[[noreturn]] void FailWithoutAny(const std::string& folder,
                                 const std::string& image_name) {
  throw Failure((colmap::ExistsDir(folder)
                     ? "There are no depth maps in "
                     : "There is no folder of depth maps ") +
                folder +
                "; they have the names of the images with .exr, .pfm, .png or "
                ".npy after them, as in " +
                image_name + kDepthFileExtensions[0] +
                ", and without prior_path none are needed");
}

}  // namespace

std::string PriorPath(const std::string& folder,
                      const std::string& image_name) {
  if (folder.empty()) {
    return "";
  }
  const fs::path name = image_name;
  for (const fs::path& stem :
       {name, fs::path(name).replace_extension(), name.stem()}) {
    for (const char* extension : kDepthFileExtensions) {
      const std::string path =
          colmap::JoinPaths(folder, stem.string() + extension);
      if (colmap::ExistsFile(path)) {
        return path;
      }
    }
  }
  return "";
}

std::map<int, FittedPrior> FitPriors(const std::string& folder,
                                     const colmap::mvs::Model& model,
                                     const std::vector<SceneView>& scene,
                                     const std::vector<int>& views) {
  if (folder.empty() || views.empty()) {
    return {};
  }
  // By path, the view that it is of.
  std::map<std::string, int> found;
  for (const int index : views) {
    const std::string path = PriorPath(folder, scene[index].name);
    if (path.empty()) {
      continue;
    }
    const auto [owner, is_new] = found.emplace(path, index);
    if (!is_new) {
      throw Failure("The depth map " + path + " could be that of both " +
                    scene[owner->second].name + " and " + scene[index].name +
                    "; give it the whole name of its image, with that of its "
                    "folder");
    }
  }
  if (found.empty()) {
    FailWithoutAny(folder, scene[views[0]].name);
  }
  auto points = SeenPoints(model, scene);
  std::map<int, FittedPrior> priors;
  for (const auto& [path, index] : found) {
    if (const auto prior = FitOne(scene[index], path, points[index])) {
      priors[index] = *prior;
    }
  }
  std::cout << "Depth maps in " << folder << ": " << found.size() << " of "
            << views.size() << " views have one, and " << priors.size()
            << " of them fit." << std::endl;
  return priors;
}

Map<float> ReadPrior(const FittedPrior& prior) {
  Map<float> map = ReadDepthFile(prior.path);
  for (int row = 0; row < map.height(); ++row) {
    for (int col = 0; col < map.width(); ++col) {
      float& value = map.At(row, col);
      value = prior.fit.Depth(value, (col + 0.5) / map.width(),
                              (row + 0.5) / map.height());
    }
  }
  return map;
}

}  // namespace tapa
