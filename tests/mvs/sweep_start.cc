#include "tests/mvs/sweep_start.h"

#include <cmath>

#include "src/mvs/camera_table.h"
#include "src/mvs/sweep/hypotheses.h"

namespace tapa {

Plane PlaneThrough(float depth, const Vec3& normal) {
  const float norm = std::sqrt(Dot(normal, normal));
  return {(1 / norm) * normal, -depth * normal.z / norm};
}

PlaneSet DrawAtRandom(const std::vector<Plane>& planes, int width, int height,
                      std::mt19937* random) {
  PlaneSet set;
  set.planes = planes;
  set.index = Map<uint16_t>(width, height);
  for (size_t i = 0; i < set.index.size(); ++i) {
    const size_t draw = (*random)() % (planes.size() + 1);
    set.index.data()[i] =
        draw < planes.size() ? static_cast<uint16_t>(draw) : PlaneSet::kNone;
  }
  return set;
}

GuideMaps MakeGuide(const SyntheticPlane& scene, std::mt19937* random) {
  const Problem& problem = scene.problem();
  const Map<uint8_t>& image = *problem.reference.image;
  const float depth = 4.0f;
  const Vec3 normal = scene.normal();
  GuideMaps guide;
  guide.depth_min = problem.depth_min;
  guide.depth_max = problem.depth_max;
  guide.weight_range = 0.2f;
  guide.textureness = Map<float>(image.width(), image.height());
  for (size_t i = 0; i < guide.textureness.size(); ++i) {
    guide.textureness.data()[i] = 0.2f + (*random)() % 1000 * 0.0008f;
  }
  const Plane truth = PlaneThrough(depth, normal);
  guide.fine = DrawAtRandom({truth,
                             PlaneThrough(1.002f * depth, normal),
                             PlaneThrough(1.2f * depth, normal),
                             PlaneThrough(depth, {-0.2f, 0.3f, -1}),
                             PlaneThrough(0.4f * depth, normal),
                             PlaneThrough(3 * depth, normal),
                             {-truth.normal, -truth.distance},
                             {truth.normal, -truth.distance}},
                            image.width(), image.height(), random);
  guide.coarse = DrawAtRandom({PlaneThrough(0.999f * depth, normal),
                               truth,
                               PlaneThrough(depth, {0.25f, -0.1f, -1}),
                               PlaneThrough(1.4f * depth, {0, 0, -1}),
                               {{1, 0, 0}, 1e-6f}},
                              image.width(), image.height(), random);
  guide.depth_prior = Map<PackedDepthNormal>(image.width(), image.height());
  for (size_t i = 0; i < guide.depth_prior.size(); ++i) {
    const float factors[] = {1, 1.001f, 0.97f, 1.3f};
    const size_t draw = (*random)() % 5;
    // Clearly another plane than that of a neighbour, which may be propagated.
    const float own = 1 + 1e-5f * ((*random)() % 1000);
    guide.depth_prior.data()[i] =
        draw < 4 ? Pack({own * factors[draw] * scene.depth().data()[i], normal})
                 : PackNothing();
  }
  return guide;
}

Start StartNearTruth(const SyntheticPlane& scene) {
  const Map<float>& truth = scene.depth();
  Start start = {Map<float>(truth.width(), truth.height()),
                 Map<Vec3>(truth.width(), truth.height())};
  const RefCamera camera = CameraTable(scene.problem()).reference();
  std::mt19937 random(4);
  std::uniform_real_distribution<float> factors(0.7f, 1.4f);
  for (int row = 0; row < truth.height(); ++row) {
    for (int col = 0; col < truth.width(); ++col) {
      start.depth.At(row, col) =
          truth.At(row, col) * (random() % 2 ? factors(random) : 1.001f);
      start.normal.At(row, col) =
          RandomNormal(Random(random(), 0, 0), camera.Ray(row, col));
    }
  }
  return start;
}

}  // namespace tapa
