// Whole estimations on a GPU; without one they are skipped, but they also run
// on the emulated one (emulated_cuda/emulator.h).

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "src/mvs/device_error.h"
#include "src/mvs/devices.h"
#include "src/mvs/estimate_depth.h"
#include "tests/mvs/masked_half.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

SyntheticPlane MakeScene() {
  SyntheticOptions options;
  options.width = static_cast<int>(96 * SceneScale());
  options.height = static_cast<int>(72 * SceneScale());
  options.num_sources = 6;
  options.focal_length = 1.2 * options.width;
  options.wall = 0.4;
  options.noise = 2;
  return SyntheticPlane(options);
}

// Share of the pixels whose depth is right to one per cent.
double ShareRight(const Options& options, const SyntheticPlane& scene) {
  const auto estimate = EstimateDepth(options, scene.problem());
  size_t count = 0;
  for (size_t i = 0; i < scene.depth().size(); ++i) {
    const float truth = scene.depth().data()[i];
    count +=
        std::abs(estimate->depth.data()[i] - truth) <= 0.01f * truth ? 1 : 0;
  }
  return static_cast<double>(count) / scene.depth().size();
}

int FirstUsable(const DeviceList& list) {
  int device = 0;
  while (!list.devices[device].unusable.empty()) {
    ++device;
  }
  return device;
}

TEST(CudaEstimate, IsAsGoodAsThatOfTheCpu) {
  const DeviceList list = FindDevices();
  if (!list.why_none.empty()) {
    GTEST_SKIP() << "NO GPU TEST RAN: " << list.why_none;
  }
  const int device = FirstUsable(list);
  const SyntheticPlane scene = MakeScene();
  for (const bool tapa : {false, true}) {
    Options options;
    options.geom_consistency = false;
    options.tapa.enabled = tapa;
    options.num_iterations = 3;
    const double cpu = ShareRight(options, scene);
    options.device = device;
    const double gpu = ShareRight(options, scene);
    std::printf("tapa %d: right to 1 %%: CPU %.2f %%, GPU %.2f %%\n", tapa,
                100 * cpu, 100 * gpu);
    // Chance moves the share by the inverse square root of the number of
    // pixels.
    EXPECT_GE(gpu, cpu - 0.02 / SceneScale());
  }
}

TEST(CudaEstimate, TakesAMaskForTheBorderOfTheImage) {
  const DeviceList list = FindDevices();
  if (!list.why_none.empty()) {
    GTEST_SKIP() << "NO GPU TEST RAN: " << list.why_none;
  }
  const SyntheticPlane scene{SyntheticOptions()};
  for (const bool geometric : {false, true}) {
    const MaskedHalf half(scene, geometric);
    Options options;
    options.geom_consistency = geometric;
    options.num_iterations = 1;
    options.device = FirstUsable(list);
    const auto masked = EstimateDepth(options, half.masked());
    const auto cut = EstimateDepth(options, half.cut());
    ASSERT_TRUE(masked && cut);
    EXPECT_EQ(MaskedHalf::Difference(*masked, *cut), "");
  }
}

TEST(CudaEstimate, WithoutTheDeviceIsAnErrorThatCanBeCaught) {
  const SyntheticPlane scene = MakeScene();
  Options options;
  options.geom_consistency = false;
  options.device = 1000;
  EXPECT_THROW(EstimateDepth(options, scene.problem()), DeviceError);
}

}  // namespace
}  // namespace tapa
