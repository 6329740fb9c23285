#include "src/mvs/estimate_depth.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/mvs/backends.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/cpu/memory_plan.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/tapa/stages.h"

namespace tapa {
namespace {

constexpr int kSweepsPerIteration = 4;

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
  if (options.geom_consistency &&
      !(HasSize(problem.depth, image) && HasSize(problem.normal, image))) {
    Fail(
        "the geometric pass needs a depth and a normal map of the reference "
        "image's size");
  }
}

// The photometric pass starts from random planes, the geometric one from the
// given maps, with random planes where these have none. Returns false if
// stopped.
bool InitializeEstimate(const Options& options, const Control& control,
                        Problem* problem) {
  const RefCamera camera = CameraTable(*problem).reference();
  const Map<uint8_t>& image = *problem->reference.image;
  if (!options.geom_consistency) {
    problem->depth = Map<float>(image.width(), image.height());
    problem->normal = Map<Vec3>(image.width(), image.height());
  }
  for (int row = 0; row < image.height(); ++row) {
    if (control.stopped && control.stopped()) {
      return false;
    }
    for (int col = 0; col < image.width(); ++col) {
      const Vec3 ray = camera.Ray(row, col);
      float& depth = problem->depth.At(row, col);
      Vec3& normal = problem->normal.At(row, col);
      if (depth > 0 && std::isfinite(depth) && Dot(normal, ray) < 0) {
        continue;
      }
      const Random random(options.seed,
                          static_cast<uint64_t>(row) * image.width() + col,
                          kInitialSweep);
      depth = RandomDepth(random, problem->depth_min, problem->depth_max);
      normal = RandomNormal(random, ray);
    }
  }
  return true;
}

float CosineOfDegrees(double degrees) {
  return static_cast<float>(std::cos(degrees * 3.14159265358979323846 / 180));
}

// Parameters that all sweeps have in common.
SweepParams MakeSweepParams(const Options& options, const Problem& problem) {
  SweepParams params;
  params.seed = options.seed;
  params.num_samples = options.num_samples;
  params.window_radius = static_cast<float>(options.window_radius);
  params.selection = ViewSelection::FromSigma(options.ncc_sigma);
  params.prior = ViewPrior::FromAngles(options.min_triangulation_angle,
                                       options.incident_angle_sigma);
  params.geometric = options.geom_consistency;
  params.geom_weight = static_cast<float>(options.geom_consistency_regularizer);
  params.geom_max_cost = static_cast<float>(options.geom_consistency_max_cost);
  params.filter_min_prob = params.selection.Emission(
      static_cast<float>(1.0 - options.filter_min_ncc));
  params.filter_cos_min_triangulation =
      CosineOfDegrees(options.filter_min_triangulation_angle);
  params.filter_geom_max_cost =
      static_cast<float>(options.filter_geom_consistency_max_cost);
  params.filter_min_num_consistent =
      std::min(options.filter_min_num_consistent,
               static_cast<int>(problem.sources.size()));
  // TAPA looks at the filter's verdict itself; patches without texture have no
  // photometric support, so it does not count.
  if (options.tapa.enabled) {
    params.filter_min_num_consistent = 0;
    if (options.geom_consistency) {
      params.filter_min_prob = 0;
    }
  }
  return params;
}

// Sets what changes from sweep to sweep: random changes shrink by half in every
// iteration, and trust in the previous selection grows linearly from 0.
void AdvanceSweepParams(const Options& options, int iteration, int sweep,
                        SweepParams* params) {
  params->index = iteration * kSweepsPerIteration + sweep;
  params->perturbation = static_cast<float>(
      std::pow(2.0, -(iteration + sweep / double{kSweepsPerIteration})));
  const int num_sweeps = options.num_iterations * kSweepsPerIteration;
  params->prev_prob_weight = static_cast<float>(params->index) / num_sweeps;
  params->filter = (options.filter || options.tapa.enabled) &&
                   params->index + 1 == static_cast<uint32_t>(num_sweeps);
}

}  // namespace

std::optional<Estimate> EstimateDepth(const Options& options, Problem problem,
                                      const Control& control) {
  options.Check();
  CheckProblem(options, problem);

  std::unique_ptr<Backend> backend = options.device < 0
                                         ? MakeCpuBackend(options, problem)
                                         : MakeCudaBackend(options, problem);

  // The first costs take about as long as one sweep.
  const int num_steps = options.num_iterations * kSweepsPerIteration + 1;
  int step = 0;
  const ProgressCallback progress = [&](double done) {
    if (control.progress) {
      control.progress((step + done) / num_steps);
    }
    return !control.stopped || !control.stopped();
  };

  if (!InitializeEstimate(options, control, &problem) ||
      !backend->SetEstimate(std::move(problem.depth), std::move(problem.normal),
                            progress)) {
    return std::nullopt;
  }

  std::unique_ptr<TapaStages> tapa;
  if (options.tapa.enabled) {
    tapa = std::make_unique<TapaStages>(options, problem, control);
    tapa->Begin(backend.get());
  }

  SweepParams params = MakeSweepParams(options, problem);
  for (int iteration = 0; iteration < options.num_iterations; ++iteration) {
    for (int sweep = 0; sweep < kSweepsPerIteration; ++sweep) {
      ++step;
      AdvanceSweepParams(options, iteration, sweep, &params);
      if (!backend->Sweep(params, progress)) {
        return std::nullopt;
      }
    }
    if (tapa && iteration + 1 < options.num_iterations) {
      tapa->ProposePlanes(iteration + 1, backend.get());
    }
  }
  Estimate estimate = backend->TakeResult();
  // What follows needs the memory of its images and costs.
  backend.reset();
  if (tapa) {
    tapa->Refine(&estimate);
    if (control.stopped && control.stopped()) {
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
  return CpuBackendMemory(options, problem) +
         (options.tapa.enabled ? pixels * kTapaBytesPerPixel : 0);
}

}  // namespace tapa
