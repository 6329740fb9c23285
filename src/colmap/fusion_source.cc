#include "src/colmap/fusion_source.h"

#include <algorithm>
#include <cmath>

#include "src/base/failure.h"
#include "src/base/machine_limits.h"
#include "src/colmap/fusion_input.h"
#include "src/colmap/masks.h"
#include "src/fusion/packed_normal.h"

namespace tapa {
namespace {

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

}  // namespace

FusionSource::FusionSource(const colmap::mvs::StereoFusionOptions& options,
                           const WorkspaceLocation& location, Pass pass)
    : options_(options), location_(location), pass_(pass) {
  const colmap::mvs::Model model = ReadModel(location);
  origin_ = model.origin;
  const std::vector<SceneView> scene =
      SceneViews(model, /* max_image_size */ -1);
  model_indices_ = ViewsToFuse(scene, location, pass, options.mask_path);
  for (const int index : model_indices_) {
    views_.push_back(scene[index]);
    FitToMaps(&views_.back());
  }
  neighbors_ = Neighbors(model);
  surfaces_ = std::make_unique<ViewCache<SurfacePixel>>(
      CacheBytes(options), [this](int view) { return ReadSurface(view); });
}

size_t FusionSource::CacheBytes(
    const colmap::mvs::StereoFusionOptions& options) {
  return static_cast<size_t>(std::min(options.agreement.cache_size * (1 << 30),
                                      FindMachineLimits().memory_bytes / 4));
}

void FusionSource::FitToMaps(SceneView* view) const {
  const auto [width, height] =
      ReadMapSize(location_.MapPath(MapKind::kDepth, view->name, pass_, 0),
                  MapKind::kDepth);
  const double longest = std::max(width, height);
  const double scale = options_.max_image_size > 0
                           ? std::min(1.0, options_.max_image_size / longest)
                           : 1;
  Resize(std::max(1, static_cast<int>(std::lround(scale * width))),
         std::max(1, static_cast<int>(std::lround(scale * height))), view);
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
  const MapRows depths(location_.MapPath(MapKind::kDepth, view.name, pass_, 0),
                       MapKind::kDepth);
  const std::string normal_path =
      location_.MapPath(MapKind::kNormal, view.name, pass_, 0);
  const int width = depths.width();
  CheckMapFile(normal_path, MapKind::kNormal, width, depths.height());
  const MapRows normals(normal_path, MapKind::kNormal);
  SurfaceMap surface(view.width, view.height);
  std::vector<float> depth(width), nx(width), ny(width), nz(width);
  // Of a map that is reduced, the pixels closest to the centres.
  const double x = static_cast<double>(width) / view.width;
  const double y = static_cast<double>(depths.height()) / view.height;
  for (int row = 0; row < view.height; ++row) {
    const int from_row = static_cast<int>((row + 0.5) * y);
    depths.Read(0, from_row, depth.data());
    normals.Read(0, from_row, nx.data());
    normals.Read(1, from_row, ny.data());
    normals.Read(2, from_row, nz.data());
    for (int col = 0; col < view.width; ++col) {
      const int c = static_cast<int>((col + 0.5) * x);
      const Vec3 normal{nx[c], ny[c], nz[c]};
      surface.At(row, col) = {Dot(normal, normal) > 0 ? depth[c] : 0,
                              PackNormal(normal)};
    }
  }
  const Map<uint8_t> mask = ReadMask(options_.mask_path, view);
  for (size_t i = 0; i < mask.size(); ++i) {
    if (mask.data()[i] != 0) {
      surface.data()[i].depth = 0;
    }
  }
  return surface;
}

}  // namespace tapa
