#include "src/mvs/estimate_depth.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/base/depth.h"
#include "src/mvs/backends.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/cpu/memory_plan.h"
#include "src/mvs/prior_planes.h"
#include "src/mvs/schedule.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/stages.h"

namespace tapa {
namespace {

// Textureness, labels and planes of two segmentations, and the chosen
// hypothesis: 13; between iterations a depth map (4), connected regions (8) and
// points (12).
constexpr size_t kTapaBytesPerPixel = 37;

// Number of the random draws before the first sweep.
constexpr uint32_t kInitialSweep = 0xFFFFFFFFu;

[[noreturn]] void Fail(const std::string& message) {
  throw std::invalid_argument(message);
}

template <typename T>
bool HasSize(const Map<T>& map, const Map<uint8_t>& image) {
  return map.width() == image.width() && map.height() == image.height();
}

void CheckView(const View& view, const std::string& name, bool needs_depth) {
  if (view.image == nullptr || view.image->empty()) {
    Fail(name + " has no image");
  }
  // Samples are addressed by 32-bit offsets in bytes, two for every pixel.
  constexpr double kMaxPixels = 1e9;
  if ((view.image->width() + 3.0) * (view.image->height() + 2.0) > kMaxPixels) {
    Fail(name + " has more than a billion pixels; lower max_image_size");
  }
  if (!(view.camera.fx > 0) || !(view.camera.fy > 0)) {
    Fail(name + " has a focal length that is not positive");
  }
  if (needs_depth && view.depth == nullptr) {
    Fail(name + " has no depth map, which the geometric pass needs");
  }
  if (needs_depth && !HasSize(*view.depth, *view.image)) {
    Fail(name + " has a depth map of another size than its image");
  }
}

void CheckProblem(const Options& options, const Problem& problem) {
  CheckView(problem.reference, "the reference view", false);
  if (problem.sources.empty()) {
    Fail("the reference view has no source views");
  }
  for (size_t m = 0; m < problem.sources.size(); ++m) {
    CheckView(problem.sources[m], "source view " + std::to_string(m),
              options.geom_consistency);
  }
  if (!(problem.depth_min > 0) || !(problem.depth_max >= problem.depth_min) ||
      !std::isfinite(problem.depth_max)) {
    Fail("the depth range must be positive and not empty");
  }
  const Map<uint8_t>& image = *problem.reference.image;
  if (options.tapa.enabled && problem.reference_color != nullptr &&
      !HasSize(*problem.reference_color, image)) {
    Fail("the colour photograph has another size than the grey one");
  }
  const bool starts_at_random =
      problem.depth.empty() && !options.geom_consistency;
  if (!starts_at_random &&
      !(HasSize(problem.depth, image) && HasSize(problem.normal, image))) {
    Fail(
        "an estimation that starts from maps, as the geometric pass does, "
        "needs "
        "a depth and a normal map of the reference image's size");
  }
  if (!problem.mask.empty() && !HasSize(problem.mask, image)) {
    Fail("the mask has another size than the reference image");
  }
}

// An estimation starts from the given maps, if there are any, and from random
// planes where these have none; masked pixels have none. Returns false if
// stopped.
bool InitializeEstimate(const Options& options, const Control& control,
                        Problem* problem) {
  const RefCamera camera = CameraTable(*problem).reference();
  const Map<uint8_t>& image = *problem->reference.image;
  if (problem->depth.empty()) {
    problem->depth = Map<float>(image.width(), image.height());
    problem->normal = Map<Vec3>(image.width(), image.height());
  }
  for (int row = 0; row < image.height(); ++row) {
    if (control.IsStopped()) {
      return false;
    }
    for (int col = 0; col < image.width(); ++col) {
      const size_t pixel = static_cast<size_t>(row) * image.width() + col;
      const Vec3 ray = camera.Ray(row, col);
      float& depth = problem->depth.At(row, col);
      Vec3& normal = problem->normal.At(row, col);
      if (problem->IsMasked(pixel)) {
        depth = 0;
        normal = Vec3();
        continue;
      }
      if (IsDepth(depth) && Dot(normal, ray) < 0) {
        continue;
      }
      const Random random(options.seed, pixel, kInitialSweep);
      depth = RandomDepth(random, problem->depth_min, problem->depth_max);
      normal = RandomNormal(random, ray);
    }
  }
  return true;
}

// The progress of steps that take about the same time each, as one.
class StepProgress {
 public:
  StepProgress(const Control& control, int num_steps)
      : control_(control), num_steps_(num_steps) {}

  // For the next step.
  ProgressCallback Next() {
    return [this, step = next_++](double done) {
      if (control_.progress) {
        control_.progress((step + done) / num_steps_);
      }
      return !control_.IsStopped();
    };
  }

 private:
  const Control& control_;
  const int num_steps_;
  int next_ = 0;
};

}  // namespace

std::optional<Estimate> EstimateDepth(const Options& options, Problem problem,
                                      const Control& control) {
  options.Check();
  CheckProblem(options, problem);

  std::unique_ptr<Backend> backend = options.device < 0
                                         ? MakeCpuBackend(options, problem)
                                         : MakeCudaBackend(options, problem);

  const bool has_start = !problem.depth.empty();
  const Schedule schedule(options, static_cast<int>(problem.sources.size()),
                          has_start);
  // The first costs take about as long as one sweep.
  StepProgress progress(control, schedule.num_sweeps() + 1);
  if (!InitializeEstimate(options, control, &problem)) {
    return std::nullopt;
  }
  // What follows sees a problem without maps to start from.
  if (!backend->SetEstimate(std::exchange(problem.depth, {}),
                            std::exchange(problem.normal, {}),
                            progress.Next())) {
    return std::nullopt;
  }

  if (!problem.prior.empty()) {
    backend->SetDepthPrior(PriorPlanes(problem));
    problem.prior = {};
  }
  std::unique_ptr<TapaStages> tapa;
  if (options.tapa.enabled) {
    tapa = std::make_unique<TapaStages>(options, problem, control);
    tapa->Begin(has_start, backend.get());
  }

  for (int i = 0; i < schedule.num_sweeps(); ++i) {
    if (tapa && i > 0 && i % Schedule::kSweepsPerIteration == 0) {
      tapa->ProposePlanes(i / Schedule::kSweepsPerIteration, backend.get());
    }
    if (!backend->Sweep(schedule.At(i), progress.Next())) {
      return std::nullopt;
    }
  }
  Estimate estimate = backend->TakeResult();
  // What follows needs the memory of its images and costs.
  backend.reset();
  if (tapa) {
    tapa->Refine(&estimate);
    if (control.IsStopped()) {
      return std::nullopt;
    }
    if (control.record != nullptr) {
      *control.record = tapa->TakeRecord();
    }
  }
  return estimate;
}

size_t EstimateDepthMemory(const Options& options, const Problem& problem) {
  const size_t pixels = problem.reference.image->size();
  const size_t prior = problem.prior.empty()
                           ? 0
                           : problem.prior.size() * sizeof(float) +
                                 pixels * sizeof(PackedDepthNormal);
  return CpuBackendMemory(options, problem) + problem.mask.size() + prior +
         (options.tapa.enabled ? pixels * kTapaBytesPerPixel : 0);
}

}  // namespace tapa
