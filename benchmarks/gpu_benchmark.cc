// Speed of the CUDA backend, next to its naive reference and to what the chip
// can do. Needs nothing but a driver:
//
//   gpu_benchmark [WIDTH HEIGHT NUM_SOURCES]
//
// Prints one table per problem. Without a GPU it says so and exits with 77.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <utility>

#include "benchmarks/wide_scene.h"
#include "src/mvs/cuda/memory_plan.h"
#include "src/mvs/devices.h"
#include "src/mvs/schedule.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/testing.h"

namespace tapa {
namespace {

constexpr int kSkipped = 77;
// Bilinear samples and single-precision operations (a fused multiply-add is
// two) of a multiprocessor in a cycle; Turing and A100 have half the latter.
constexpr double kSamplesPerCycle = 4;
constexpr double kFlopsPerCycle = 256;
// Operations on a sample, as counted in SumSamples (src/mvs/cuda/patch.h).
constexpr double kFlopsPerSample = 22;

struct Mode {
  const char* name;
  bool geometric;
  bool tapa;
  bool naive;
  // Of the whole image, from which the first sweep is counted.
  int num_sweeps;
};

constexpr Mode kModes[] = {
    {"photometric", false, false, false, 8},
    {"geometric", true, false, false, 8},
    {"photometric, TAPA", false, true, false, 8},
    {"geometric, TAPA", true, true, false, 8},
    // It takes its time.
    {"photometric, naive", false, false, true, 1},
    {"geometric, naive", true, false, true, 1},
};

// Every pixel tries a plane near the truth and one that is farther off.
void SetGuide(const WideScene& scene, Backend* backend) {
  const Map<uint8_t>& image = *scene.problem().reference.image;
  const auto set = [&](float factor) {
    PlaneSet planes;
    planes.planes = {{{0, 0, -1}, factor * scene.depth()}};
    planes.index = Map<uint16_t>(image.width(), image.height(), 0);
    return planes;
  };
  backend->SetTextureness(Map<float>(image.width(), image.height(), 0.9f));
  backend->SetPlanes(set(1.001f), set(1.05f));
}

void SetRandomEstimate(const Problem& problem, Backend* backend) {
  const Map<uint8_t>& image = *problem.reference.image;
  Map<float> depth(image.width(), image.height());
  Map<Vec3> normal(image.width(), image.height());
  for (size_t i = 0; i < depth.size(); ++i) {
    const Random random(1, i, 0);
    depth.data()[i] = RandomDepth(random, problem.depth_min, problem.depth_max);
    normal.data()[i] = RandomNormal(random, {0, 0, 1});
  }
  backend->SetEstimate(std::move(depth), std::move(normal),
                       [](double) { return true; });
}

struct Result {
  DeviceProfile profile;
  double first_sweep_seconds = 0;
  double seconds_per_sweep = 0;
};

Result Measure(const WideScene& scene, const Mode& mode, int device) {
  Options options;
  options.device = device;
  options.geom_consistency = mode.geometric;
  options.tapa.enabled = mode.tapa;
  Result result;
  CudaSwitches switches;
  switches.naive_kernel = mode.naive;
  switches.profile = &result.profile;
  const Problem& problem = scene.problem();
  const auto backend = MakeCudaBackendForTesting(options, problem, switches);
  const Schedule schedule(options, static_cast<int>(problem.sources.size()),
                          /* has_start */ true);
  SetRandomEstimate(problem, backend.get());
  if (mode.tapa) {
    SetGuide(scene, backend.get());
  }
  const DeviceProfile& profile = result.profile;
  for (int i = 0; i < mode.num_sweeps; ++i) {
    backend->Sweep(schedule.At(i), [](double) { return true; });
    if (i == 0) {
      result.first_sweep_seconds =
          profile.sweep_seconds + profile.checkpoint_seconds;
    }
  }
  result.seconds_per_sweep =
      (profile.sweep_seconds + profile.checkpoint_seconds) / mode.num_sweeps;
  return result;
}

// Before anything is timed: kernels are loaded when they are launched first,
// and the clock rises under load.
void WarmUp(int device, int width, int height, int num_sources) {
  const WideScene scene(std::min(width, 640), std::min(height, 480),
                        std::min(num_sources, 10));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  do {
    for (const Mode& mode : kModes) {
      Measure(scene, mode, device);
    }
  } while (std::chrono::steady_clock::now() < end);
}

void PrintLimits(const Result& result, size_t num_pixels, int num_sources) {
  const DeviceProfile& p = result.profile;
  // The kernel of the first costs measures every view once and little else.
  const double samples = 32.0 * num_pixels * num_sources;
  const double rate = samples / p.initialize_seconds;
  const double chip = p.num_multiprocessors * p.clock_hz;
  std::printf(
      "  correlation alone (first costs): %.1f G samples/s, %.1f %% of the "
      "texture limit, %.1f %% of the arithmetic limit\n",
      1e-9 * rate, 100 * rate / (chip * kSamplesPerCycle),
      100 * rate * kFlopsPerSample / (chip * kFlopsPerCycle));
}

void Run(int device, int width, int height, int num_sources) {
  const WideScene scene(width, height, num_sources);
  const size_t num_pixels = static_cast<size_t>(width) * height;
  std::printf("%d x %d, %d source views\n", width, height, num_sources);
  std::printf("  %-20s %12s %12s %9s %9s %6s %10s %8s %11s %9s\n", "",
              "Mpx sweeps/s", "first sweep", "occupancy", "registers", "lines",
              "first cost", "messages", "sweep", "to naive");
  double naive[2] = {0, 0};
  Result results[std::size(kModes)];
  for (size_t i = 0; i < std::size(kModes); ++i) {
    results[i] = Measure(scene, kModes[i], device);
    if (kModes[i].naive) {
      naive[kModes[i].geometric] = results[i].first_sweep_seconds;
    }
  }
  for (size_t i = 0; i < std::size(kModes); ++i) {
    const Result& r = results[i];
    const DeviceProfile& p = r.profile;
    const double total =
        p.initialize_seconds + p.checkpoint_seconds + p.sweep_seconds;
    std::printf(
        "  %-20s %12.2f %12.2f %8.1f%% %9d %6d %9.1f%% %7.1f%% %10.1f%% "
        "%8.2fx\n",
        kModes[i].name, 1e-6 * num_pixels / r.seconds_per_sweep,
        1e-6 * num_pixels / r.first_sweep_seconds, 100 * p.occupancy,
        p.registers, p.resident_lines, 100 * p.initialize_seconds / total,
        100 * p.checkpoint_seconds / total, 100 * p.sweep_seconds / total,
        naive[kModes[i].geometric] / r.first_sweep_seconds);
  }
  PrintLimits(results[0], num_pixels, num_sources);
  std::printf(
      "  TAPA's weights and planes: sweeps take %.1f %% longer "
      "(photometric), %.1f %% (geometric)\n",
      100 * (results[2].seconds_per_sweep / results[0].seconds_per_sweep - 1),
      100 * (results[3].seconds_per_sweep / results[1].seconds_per_sweep - 1));
  Options options;
  options.tapa.enabled = true;
  std::printf(
      "  device memory, geometric with TAPA: %.1f bytes per pixel\n\n",
      static_cast<double>(EstimateDepthDeviceMemory(options, scene.problem())) /
          num_pixels);
}

int Main(int argc, char** argv) {
  const DeviceList list = FindDevices();
  if (!list.why_none.empty()) {
    std::printf("SKIPPED: there is no GPU to measure (%s)\n",
                list.why_none.c_str());
    return kSkipped;
  }
  int device = 0;
  while (!list.devices[device].unusable.empty()) {
    ++device;
  }
  std::printf("GPU %d: %s\n\n", device, list.devices[device].name.c_str());
  if (argc == 4) {
    const int width = std::atoi(argv[1]);
    const int height = std::atoi(argv[2]);
    const int num_sources = std::atoi(argv[3]);
    WarmUp(device, width, height, num_sources);
    Run(device, width, height, num_sources);
  } else {
    WarmUp(device, 960, 640, 10);
    Run(device, 960, 640, 10);
    Run(device, 3200, 2130, 20);
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace tapa

int main(int argc, char** argv) {
  try {
    return tapa::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ERROR: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
