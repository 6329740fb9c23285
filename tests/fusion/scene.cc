#include "tests/fusion/scene.h"

#include <cmath>

#include "src/fusion/packed_normal.h"

namespace tapa {

Camera SceneCamera(double x, double angle, int width, int height) {
  Camera camera;
  camera.fx = camera.fy = width;
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  const double c = std::cos(angle), s = std::sin(angle);
  camera.R = {c, 0, s, 0, 1, 0, -s, 0, c};
  camera.t = {-c * x, 0, s * x};
  return camera;
}

SurfaceMap SeePlane(const ScenePlane& plane, const Camera& camera, int width,
                    int height, double scale) {
  const auto& R = camera.R;
  const Vec3& n = plane.normal;
  const double nx = R[0] * n.x + R[1] * n.y + R[2] * n.z;
  const double ny = R[3] * n.x + R[4] * n.y + R[5] * n.z;
  const double nz = R[6] * n.x + R[7] * n.y + R[8] * n.z;
  // n X = d with X = R^T (x - t).
  const double d =
      plane.distance + nx * camera.t[0] + ny * camera.t[1] + nz * camera.t[2];
  SurfaceMap map(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const double u = (col + 0.5 - camera.cx) / camera.fx;
      const double v = (row + 0.5 - camera.cy) / camera.fy;
      map.At(row, col).depth =
          static_cast<float>(scale * d / (nx * u + ny * v + nz));
      map.At(row, col).normal =
          PackNormal({static_cast<float>(nx), static_cast<float>(ny),
                      static_cast<float>(nz)});
    }
  }
  return map;
}

void Scene::Add(const Camera& camera, const SurfaceMap& surface) {
  FusionView view;
  view.camera = camera;
  view.width = surface.width();
  view.height = surface.height();
  const int index = static_cast<int>(views.size());
  for (int i = 0; i < index; ++i) {
    views[i].neighbors.push_back(index);
    view.neighbors.push_back(i);
  }
  views.push_back(view);
  surfaces.push_back(std::make_shared<SurfaceMap>(surface));
}

FusionProblem Scene::Problem() const {
  FusionProblem problem;
  problem.views = views;
  problem.read_surface = [this](int view) { return surfaces[view]; };
  problem.read_colors = [this](int view) {
    return Map<Rgb>(views[view].width, views[view].height,
                    Rgb{static_cast<uint8_t>(view + 1), 2, 3});
  };
  return problem;
}

Scene RowOfViews(int count, const ScenePlane& plane) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const Camera camera = SceneCamera(0.5 * i, 0.05 * i, 64, 48);
    scene.Add(camera, SeePlane(plane, camera, 64, 48));
  }
  return scene;
}

}  // namespace tapa
