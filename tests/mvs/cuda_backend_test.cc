// The CUDA backend on an emulated GPU: what it takes of the device, and what
// becomes of an estimation when the device fails.

#include <gtest/gtest.h>

#include <future>
#include <string>
#include <utility>
#include <vector>

#include "src/mvs/backends.h"
#include "src/mvs/cuda/memory_plan.h"
#include "src/mvs/cuda/memory_share.h"
#include "src/mvs/device_error.h"
#include "src/mvs/device_trial.h"
#include "src/mvs/devices.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/schedule.h"
#include "tests/mvs/emulated_cuda/emulator.h"
#include "tests/mvs/sweep_start.h"
#include "tests/mvs/synthetic.h"

namespace tapa {
namespace {

SyntheticPlane SmallScene() {
  SyntheticOptions options;
  options.width = static_cast<int>(20 * SceneScale());
  options.height = static_cast<int>(18 * SceneScale());
  options.focal_length = 1.2 * options.width;
  options.num_sources = 3;
  return SyntheticPlane(options);
}

Options GpuOptions(bool geometric, bool tapa) {
  Options options;
  options.device = 0;
  options.geom_consistency = geometric;
  options.tapa.enabled = tapa;
  options.num_iterations = 2;
  options.window_radius = 2;
  return options;
}

// Everything is given back, and what was taken is what was announced.
TEST(CudaBackend, TakesTheMemoryItSays) {
  const SyntheticPlane scene = SmallScene();
  for (const bool geometric : {false, true}) {
    for (const bool tapa : {false, true}) {
      Problem problem = geometric ? scene.GeometricProblem() : scene.problem();
      if (tapa) {
        problem.prior = scene.depth();
      }
      const Options options = GpuOptions(geometric, tapa);
      emulated_cuda::Reset({});
      ASSERT_TRUE(EstimateDepth(options, problem));
      const emulated_cuda::Usage usage = emulated_cuda::GetUsage();
      EXPECT_EQ(usage.num_objects, 0);
      EXPECT_EQ(usage.bytes, 0);
      const size_t announced = EstimateDepthDeviceMemory(options, problem);
      // Cameras and planes are not counted.
      EXPECT_GE(usage.peak_bytes, announced);
      EXPECT_LE(usage.peak_bytes, announced + 2000);
    }
  }
}

TEST(CudaBackend, SaysWhatMemoryIsShort) {
  const SyntheticPlane scene = SmallScene();
  const Options options = GpuOptions(false, false);
  emulated_cuda::Settings settings;
  settings.memory_bytes =
      EstimateDepthDeviceMemory(options, scene.problem()) - 1;
  emulated_cuda::Reset(settings);
  try {
    EstimateDepth(options, scene.problem());
    FAIL();
  } catch (const DeviceLimitError& error) {
    EXPECT_EQ(std::string(error.what()),
              "it takes 1 MB of GPU memory, of which there are 0");
  }
  EXPECT_EQ(emulated_cuda::GetUsage().peak_bytes, 0);
}

// Whichever call fails, the error can be caught, it says what was done, nothing
// stays behind, and the device is as good as before unless it is broken.
TEST(CudaBackend, SurvivesAnyFailure) {
  const SyntheticPlane scene = SmallScene();
  Options options = GpuOptions(false, true);
  options.num_iterations = 1;
  emulated_cuda::Reset({});
  ASSERT_TRUE(EstimateDepth(options, scene.problem()));
  const int num_calls = emulated_cuda::GetUsage().num_calls;
  ASSERT_GT(num_calls, 50);
  for (const bool for_good : {false, true}) {
    for (int call = 1; call <= num_calls; call += for_good ? 7 : 1) {
      emulated_cuda::Settings settings;
      settings.failing_call = call;
      settings.fails_for_good = for_good;
      emulated_cuda::Reset(settings);
      try {
        EstimateDepth(options, scene.problem());
        // The last ones wait for streams that have nothing to do any more.
        EXPECT_GT(call, num_calls - 4) << "nobody noticed";
      } catch (const DeviceError& error) {
        EXPECT_NE(
            std::string(error.what()).find(": unspecified launch failure"),
            std::string::npos)
            << error.what();
      }
      EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0) << "call " << call;
    }
  }
}

// Stopped at any time, it stops soon and gives everything back.
TEST(CudaBackend, StopsSoon) {
  const SyntheticPlane scene = SmallScene();
  const Options options = GpuOptions(false, true);
  emulated_cuda::Settings settings;
  settings.turns = 3;
  // Counts how often it asks, and stops it the last time.
  int num_asked = 0;
  const auto run = [&](int last) {
    emulated_cuda::Reset(settings);
    num_asked = 0;
    Control control;
    control.stopped = [&] { return ++num_asked >= last; };
    return EstimateDepth(options, scene.problem(), control).has_value();
  };
  ASSERT_TRUE(run(1000000));
  const int num_times = num_asked;
  for (int last = 1; last <= num_times; last += 3) {
    EXPECT_FALSE(run(last));
    // Once more where what asked could not stop by itself.
    EXPECT_LE(num_asked, last + 2);
    EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0);
  }
}

// A problem with many views needs more shared memory than others; what others
// set up in the meantime must not take it away.
TEST(CudaBackend, GoesOnBesideSmallerProblems) {
  SyntheticOptions scene_options;
  scene_options.width = 20;
  scene_options.height = 18;
  scene_options.focal_length = 24;
  scene_options.num_sources = 60;
  const SyntheticPlane large(scene_options);
  const SyntheticPlane small = SmallScene();
  Options options = GpuOptions(false, false);
  options.window_radius = 10;
  options.window_step = 2;
  emulated_cuda::Reset({});
  const auto keep_going = [](double) { return true; };
  const auto sweep = [&](Backend* backend, const SyntheticPlane& scene) {
    const Start start = StartNearTruth(scene);
    backend->SetEstimate(start.depth, start.normal, keep_going);
    backend->Sweep(
        Schedule(options, scene.problem().sources.size(), true).At(0),
        keep_going);
  };
  const auto first = MakeCudaBackend(options, large.problem());
  const auto second = MakeCudaBackend(options, small.problem());
  sweep(second.get(), small);
  EXPECT_NO_THROW(sweep(first.get(), large));
}

// Two views on a GPU that has memory for one wait for each other.
TEST(CudaBackend, WaitsForMemory) {
  const SyntheticPlane scene = SmallScene();
  const Options options = GpuOptions(false, false);
  emulated_cuda::Settings settings;
  settings.memory_bytes =
      EstimateDepthDeviceMemory(options, scene.problem()) * 3 / 2;
  emulated_cuda::Reset(settings);
  const auto estimate = [&] {
    try {
      return EstimateDepth(options, scene.problem()).has_value();
    } catch (const DeviceError&) {
      return false;
    }
  };
  std::vector<std::future<bool>> estimates;
  for (int i = 0; i < 4; ++i) {
    estimates.push_back(std::async(std::launch::async, estimate));
  }
  for (std::future<bool>& result : estimates) {
    EXPECT_TRUE(result.get());
  }
  EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0);
}

// A share that ends between the error and the wait has ended, too.
TEST(CudaBackend, WaitsForNoneThatHasEnded) {
  emulated_cuda::Reset({});
  const int num_ended = MemoryShare::NumEnded(0);
  EXPECT_FALSE(MemoryShare::WaitForEnd(0, num_ended));
  MemoryShare(0, 1).Settle();
  EXPECT_TRUE(MemoryShare::WaitForEnd(0, num_ended));
  // What never settled had nothing that others could take.
  MemoryShare(0, 1);
  EXPECT_FALSE(MemoryShare::WaitForEnd(0, num_ended + 1));
}

// More views than the shared memory has room for.
TEST(CudaBackend, SaysWhatIsTooLarge) {
  const SyntheticPlane scene = SmallScene();
  Problem problem = scene.problem();
  problem.sources.resize(2000, problem.sources[0]);
  emulated_cuda::Reset({});
  EXPECT_THROW(MakeCudaBackend(GpuOptions(false, false), problem),
               DeviceLimitError);
  EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0);
}

TEST(DeviceTrial, FindsWhatIsWrong) {
  std::vector<std::pair<int, int>> windows = {{5, 1}, {3, 1}, {3, 2}, {16, 2}};
  if (SceneScale() == 1) {
    windows.emplace_back(32, 2);
  }
  for (const auto& [radius, step] : windows) {
    Options options;
    options.window_radius = radius;
    options.window_step = step;
    emulated_cuda::Settings settings;
    emulated_cuda::Reset(settings);
    EXPECT_EQ(TryDevice(0, options), "") << radius << " " << step;
    settings.black_textures = true;
    emulated_cuda::Reset(settings);
    EXPECT_EQ(TryDevice(0, options).find("of a small test it computes "), 0)
        << radius << " " << step;
  }
  emulated_cuda::Settings settings;
  settings.failing_call = 50;
  emulated_cuda::Reset(settings);
  EXPECT_NE(TryDevice(0, Options()).find("unspecified launch failure"),
            std::string::npos);
}

TEST(CudaDevices, AreListed) {
  emulated_cuda::Settings settings;
  settings.num_devices = 2;
  emulated_cuda::Reset(settings);
  const DeviceList two = FindDevices();
  EXPECT_EQ(two.why_none, "");
  ASSERT_EQ(two.devices.size(), 2);
  EXPECT_EQ(two.devices[1].name, "Emulated GPU");

  settings.num_devices = 0;
  emulated_cuda::Reset(settings);
  EXPECT_EQ(FindDevices().why_none,
            "there is no NVIDIA GPU that this program may use");

  settings.num_devices = 1;
  settings.failing_call = 1;
  settings.failure = cudaErrorInsufficientDriver;
  emulated_cuda::Reset(settings);
  EXPECT_EQ(FindDevices().why_none.find("the NVIDIA driver is too old"), 0);
}

}  // namespace
}  // namespace tapa
