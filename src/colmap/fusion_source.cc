#include "src/colmap/fusion_source.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "src/base/failure.h"
#include "src/colmap/progress.h"
#include "src/fusion/packed_normal.h"
#include "util/bitmap.h"
#include "util/misc.h"

namespace tapa {
namespace {

// The names that fusion.cfg lists, without comments.
std::vector<std::string> ReadNames(const std::string& path) {
  if (!colmap::ExistsFile(path)) {
    throw Failure("There is no list of images " + path +
                  "; image_undistorter writes it");
  }
  std::vector<std::string> names;
  for (std::string name : colmap::ReadTextFileLines(path)) {
    colmap::StringTrim(&name);
    if (!name.empty() && name[0] != '#') {
      names.push_back(name);
    }
  }
  return names;
}

// The same camera for an image of another size.
void Resize(int width, int height, SceneView* view) {
  const double x = static_cast<double>(width) / view->width;
  const double y = static_cast<double>(height) / view->height;
  view->camera.fx *= x;
  view->camera.cx *= x;
  view->camera.fy *= y;
  view->camera.cy *= y;
  view->width = width;
  view->height = height;
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

// Whether a map may belong to a photograph: of the same shape to a pixel, and
// not larger.
bool Fits(int width, int height, const SceneView& view) {
  const double difference = std::abs(1.0 * width * view.photo_height -
                                     1.0 * height * view.photo_width);
  return width <= view.photo_width && height <= view.photo_height &&
         difference <= std::max(view.photo_width, view.photo_height);
}

}  // namespace

FusionSource::FusionSource(const colmap::mvs::StereoFusionOptions& options,
                           const WorkspaceLocation& location, Pass pass)
    : options_(options), location_(location), pass_(pass) {
  const std::string list =
      colmap::JoinPaths(location.StereoPath(), "fusion.cfg");
  const colmap::mvs::Model model = ReadWorkspace(location);
  const std::vector<SceneView> scene = SceneViews(model, -1);
  std::map<std::string, int> indices;
  for (size_t i = 0; i < scene.size(); ++i) {
    indices[scene[i].name] = static_cast<int>(i);
  }
  const std::vector<std::string> names = ReadNames(list);
  std::vector<char> is_listed(scene.size());
  for (const std::string& name : names) {
    const auto found = indices.find(name);
    if (found == indices.end()) {
      throw Failure(list + " names " + name +
                    ", which is not in the sparse model");
    }
    SceneView view = scene[found->second];
    if (!is_listed[found->second] && FindMaps(&view)) {
      views_.push_back(view);
      model_indices_.push_back(found->second);
    }
    is_listed[found->second] = true;
  }
  if (views_.empty()) {
    throw Failure("There are no " + std::string(PassName(pass)) + " maps in " +
                  location.StereoPath() + "; patch_match_stereo computes them");
  }
  neighbors_ = Neighbors(model);
  surfaces_ = std::make_unique<ViewCache<SurfacePixel>>(
      static_cast<size_t>(options.agreement.cache_size * (1 << 30)),
      [this](int view) { return ReadSurface(view); });
}

bool FusionSource::FindMaps(SceneView* view) const {
  const std::string depth_path =
      location_.MapPath(MapKind::kDepth, view->name, pass_, 0);
  const std::string normal_path =
      location_.MapPath(MapKind::kNormal, view->name, pass_, 0);
  if (!colmap::ExistsPath(depth_path) && !colmap::ExistsPath(normal_path)) {
    PrintWarning("There are no maps of " + view->name + " (" + depth_path +
                 "); it is left out.");
    return false;
  }
  const auto [width, height] = ReadMapSize(depth_path, MapKind::kDepth);
  CheckMapFile(normal_path, MapKind::kNormal, width, height);
  if (!Fits(width, height, *view)) {
    throw Failure(depth_path + " has " + SizeText(width, height) +
                  " pixels, which is not the shape of its photograph of " +
                  SizeText(view->photo_width, view->photo_height));
  }
  const double longest = std::max(width, height);
  const double scale = options_.max_image_size > 0
                           ? std::min(1.0, options_.max_image_size / longest)
                           : 1;
  Resize(std::max(1, static_cast<int>(std::lround(scale * width))),
         std::max(1, static_cast<int>(std::lround(scale * height))), view);
  return true;
}

std::vector<std::vector<int>> FusionSource::Neighbors(
    const colmap::mvs::Model& model) const {
  const auto overlapping =
      model.GetMaxOverlappingImagesFromPMVS().empty()
          ? model.GetMaxOverlappingImages(model.images.size(),
                                          /* min_triangulation_angle */ 0)
          : model.GetMaxOverlappingImagesFromPMVS();
  std::vector<int> positions(model.images.size(), -1);
  for (size_t i = 0; i < model_indices_.size(); ++i) {
    positions[model_indices_[i]] = static_cast<int>(i);
  }
  std::vector<std::vector<int>> neighbors(views_.size());
  for (size_t i = 0; i < views_.size(); ++i) {
    for (const int other : overlapping[model_indices_[i]]) {
      if (positions[other] >= 0 && other != model_indices_[i] &&
          static_cast<int>(neighbors[i].size()) <
              options_.agreement.num_views) {
        neighbors[i].push_back(positions[other]);
      }
    }
  }
  return neighbors;
}

FusionProblem FusionSource::Problem() {
  FusionProblem problem;
  for (size_t i = 0; i < views_.size(); ++i) {
    FusionView view;
    view.camera = views_[i].camera;
    view.width = views_[i].width;
    view.height = views_[i].height;
    view.neighbors = neighbors_[i];
    problem.views.push_back(view);
  }
  problem.read_surface = [this](int view) { return surfaces_->Get(view); };
  problem.read_colors = [this](int view) {
    return ReadColorPhoto(views_[view]);
  };
  const auto box = options_.bounding_box;
  problem.is_wanted = [box](const Vec3& p) {
    return p.x >= box.first(0) && p.y >= box.first(1) && p.z >= box.first(2) &&
           p.x <= box.second(0) && p.y <= box.second(1) && p.z <= box.second(2);
  };
  return problem;
}

SurfaceMap FusionSource::ReadSurface(int index) const {
  const SceneView& view = views_[index];
  const Map<float> depth =
      ReadDepthMap(location_.MapPath(MapKind::kDepth, view.name, pass_, 0));
  const std::string normal_path =
      location_.MapPath(MapKind::kNormal, view.name, pass_, 0);
  CheckMapFile(normal_path, MapKind::kNormal, depth.width(), depth.height());
  const Map<Vec3> normals = ReadNormalMap(normal_path);
  SurfaceMap surface(view.width, view.height);
  // Of a map that is reduced, the pixels closest to the centres.
  const double x = static_cast<double>(depth.width()) / view.width;
  const double y = static_cast<double>(depth.height()) / view.height;
  for (int row = 0; row < view.height; ++row) {
    const int from_row = static_cast<int>((row + 0.5) * y);
    for (int col = 0; col < view.width; ++col) {
      const int from_col = static_cast<int>((col + 0.5) * x);
      const Vec3& normal = normals.At(from_row, from_col);
      SurfacePixel& pixel = surface.At(row, col);
      pixel.normal = PackNormal(normal);
      pixel.depth = Dot(normal, normal) > 0 ? depth.At(from_row, from_col) : 0;
    }
  }
  ApplyMask(view, &surface);
  return surface;
}

void FusionSource::ApplyMask(const SceneView& view, SurfaceMap* surface) const {
  const std::string path =
      colmap::JoinPaths(options_.mask_path, view.name + ".png");
  if (options_.mask_path.empty() || !colmap::ExistsFile(path)) {
    return;
  }
  colmap::Bitmap mask;
  if (!mask.Read(path, /* as_rgb */ false)) {
    throw Failure("The mask " + path + " cannot be read");
  }
  mask.Rescale(view.width, view.height, FILTER_BOX);
  for (int row = 0; row < view.height; ++row) {
    for (int col = 0; col < view.width; ++col) {
      colmap::BitmapColor<uint8_t> color;
      mask.GetPixel(col, row, &color);
      if (color.r == 0) {
        surface->At(row, col).depth = 0;
      }
    }
  }
}

}  // namespace tapa
