#ifndef TAPA_TESTS_FUSION_SCENE_H_
#define TAPA_TESTS_FUSION_SCENE_H_

#include <memory>
#include <vector>

#include "src/fusion/fuse.h"

namespace tapa {

// A plane n X = distance in the world, seen by cameras that look at it along z.
struct ScenePlane {
  Vec3 normal{0, 0, -1};
  double distance = -4;
};

// A camera at (x, 0, 0), turned by an angle in radians about y, with
// width x height pixels and a focal length of its width.
Camera SceneCamera(double x, double angle, int width, int height);

// What a camera sees of the plane, with depth multiplied by `scale`.
SurfaceMap SeePlane(const ScenePlane& plane, const Camera& camera, int width,
                    int height, double scale = 1);

// Views of one plane with its maps. Each is a neighbour of all others.
struct Scene {
  void Add(const Camera& camera, const SurfaceMap& surface);
  FusionProblem Problem() const;

  std::vector<FusionView> views;
  std::vector<std::shared_ptr<SurfaceMap>> surfaces;
};

// As many views of 64 x 48 pixels side by side.
Scene RowOfViews(int count, const ScenePlane& plane = {});

}  // namespace tapa

#endif  // TAPA_TESTS_FUSION_SCENE_H_
