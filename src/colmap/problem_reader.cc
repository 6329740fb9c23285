#include "src/colmap/problem_reader.h"

#include <algorithm>
#include <map>

#include "src/base/machine_limits.h"
#include "src/base/map_files.h"
#include "src/colmap/masks.h"
#include "util/misc.h"

namespace tapa {
namespace {

// Relative to the largest one.
constexpr float kSmallestDepth = 1e-4f;

double CacheBytes(const StereoPlan& plan) {
  const double gigabytes = plan.passes.back().options.cache_size;
  return std::min(gigabytes * 1024 * 1024 * 1024,
                  FindMachineLimits().memory_bytes / 2);
}

}  // namespace

// A depth map takes four times the bytes of its photograph.
ProblemReader::ProblemReader(const StereoPlan& plan)
    : plan_(plan),
      photos_(
          CacheBytes(plan) / 5,
          [this](int key) {
            const int level_size = Key(0, 1);
            return ReadPhoto(plan_.View(key % level_size, key / level_size));
          }),
      depth_maps_(CacheBytes(plan) * 4 / 5, [this](int key) {
        if (key >= DraftKey(0)) {
          return ReadDepth(key - DraftKey(0), 0, Pass::kDraft);
        }
        const int level_size = Key(0, 1);
        return ReadDepth(key % level_size, key / level_size,
                         Pass::kPhotometric);
      }) {}

int ProblemReader::Key(int view, int level) const {
  return level * static_cast<int>(plan_.views[0].size()) + view;
}

int ProblemReader::DraftKey(int view) const {
  return Key(view, static_cast<int>(plan_.views.size()));
}

Map<float> ProblemReader::ReadDepth(int view, int level, Pass pass) const {
  const std::string path = plan_.MapPath(MapKind::kDepth, view, pass, level);
  const SceneView& size = plan_.View(view, level);
  // A view that only others see as a source, with a map from an earlier run,
  // has one of full size alone.
  if (level > 0 && !colmap::ExistsPath(path)) {
    return ReduceDepth(ReadDepth(view, 0, pass), size.width, size.height);
  }
  CheckMapFile(path, MapKind::kDepth, size.width, size.height);
  return ReadDepthMap(path);
}

Map<Vec3> ProblemReader::ReadNormal(int view, int level, Pass pass) const {
  const std::string path = plan_.MapPath(MapKind::kNormal, view, pass, level);
  const SceneView& size = plan_.View(view, level);
  CheckMapFile(path, MapKind::kNormal, size.width, size.height);
  return ReadNormalMap(path);
}

// A geometric pass starts from the photometric one of its level, that one from
// the last pass of the level before.
DepthNormalMaps ProblemReader::ReadStart(const PassPlan& pass,
                                         const View& reference, int view) {
  if (pass.pass != Pass::kPhotometric) {
    return {*depth_maps_.Get(Key(view, pass.level)),
            ReadNormal(view, pass.level, Pass::kPhotometric)};
  }
  const int coarser = pass.level + 1;
  const Pass last = plan_.passes.back().pass;
  return HandUp(
      {ReadDepth(view, coarser, last), ReadNormal(view, coarser, last)},
      plan_.View(view, coarser).camera, reference);
}

bool ProblemReader::ReadPhotos(const std::function<bool()>& stopped) {
  // At the level that comes first, as they are kept.
  std::map<int, int> levels;
  for (const PassPlan& pass : plan_.passes) {
    for (size_t i = 0; i < plan_.problems.size(); ++i) {
      if (pass.Computes(i) && !pass.takes_drafts) {
        const ViewIndices& problem = plan_.problems[i];
        levels.emplace(problem.reference, pass.level);
        for (const int source : problem.sources) {
          levels.emplace(source, pass.level);
        }
      }
    }
  }
  for (const auto& [view, level] : levels) {
    if (stopped()) {
      return false;
    }
    photos_.Get(Key(view, level));
  }
  return true;
}

std::unique_ptr<ProblemInput> ProblemReader::Read(
    const ViewIndices& problem, const PassPlan& pass,
    const std::function<bool()>& stopped) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto input = std::make_unique<ProblemInput>();
  const auto to_view = [&](int index) {
    View view;
    view.camera = plan_.View(index, pass.level).camera;
    input->photos.push_back(photos_.Get(Key(index, pass.level)));
    view.image = input->photos.back().get();
    return view;
  };

  const SceneView& reference = plan_.View(problem.reference, pass.level);
  const bool is_geometric = pass.pass != Pass::kPhotometric;
  Problem& to = input->problem;
  to.reference = to_view(problem.reference);
  for (const int source : problem.sources) {
    if (stopped()) {
      return nullptr;
    }
    to.sources.push_back(to_view(source));
    if (is_geometric) {
      input->depth_maps.push_back(depth_maps_.Get(Key(source, pass.level)));
      to.sources.back().depth = input->depth_maps.back().get();
    }
  }
  if (pass.has_start) {
    DepthNormalMaps start = ReadStart(pass, to.reference, problem.reference);
    to.depth = std::move(start.depth);
    to.normal = std::move(start.normal);
  }
  to.mask = ReadMask(pass.options.mask_path, reference);
  // A first guess; what a pass starts from is better.
  const auto prior = plan_.priors.find(problem.reference);
  if (prior != plan_.priors.end() && !pass.has_start) {
    to.prior = ReadPrior(prior->second);
  }
  if (pass.options.tapa.enabled) {
    input->color = ReadColorPhoto(reference);
    to.reference_color = &*input->color;
  }
  const bool has_range = pass.options.depth_min >= 0;
  to.depth_min = static_cast<float>(has_range ? pass.options.depth_min
                                              : reference.depth_min);
  to.depth_max = static_cast<float>(has_range ? pass.options.depth_max
                                              : reference.depth_max);
  // The engine takes no 0, by which users mean that there is no lower end.
  to.depth_min = std::max(to.depth_min, kSmallestDepth * to.depth_max);
  return input;
}

std::unique_ptr<ProblemInput> ProblemReader::ReadDrafts(
    const ViewIndices& problem, const PassPlan& pass,
    const std::function<bool()>& stopped) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto input = std::make_unique<ProblemInput>();
  const SceneView& reference = plan_.View(problem.reference, 0);
  Problem& to = input->problem;
  to.reference.camera = reference.camera;
  to.depth = *depth_maps_.Get(DraftKey(problem.reference));
  to.normal = ReadNormal(problem.reference, 0, Pass::kDraft);
  to.mask = ReadMask(pass.options.mask_path, reference);
  for (const int source : problem.sources) {
    if (stopped()) {
      return nullptr;
    }
    View view;
    view.camera = plan_.View(source, 0).camera;
    if (plan_.is_result[source]) {
      input->depth_maps.push_back(depth_maps_.Get(DraftKey(source)));
      view.depth = input->depth_maps.back().get();
    }
    to.sources.push_back(view);
  }
  return input;
}

std::string ProblemReader::DescribeCacheUse() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return "Found in the cache: " + photos_.Use().Describe("photographs") + ", " +
         depth_maps_.Use().Describe("depth maps");
}

}  // namespace tapa
