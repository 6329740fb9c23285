#include "src/colmap/problem_reader.h"

#include <unistd.h>

#include <algorithm>
#include <set>

#include "src/base/map_files.h"

namespace tapa {
namespace {

double CacheBytes(const StereoPlan& plan) {
  const double gigabytes = plan.passes.back().options.cache_size;
  const double memory = 1.0 * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
  return std::min(gigabytes * 1024 * 1024 * 1024, memory / 2);
}

}  // namespace

// A depth map takes four times the bytes of its photograph.
ProblemReader::ProblemReader(const StereoPlan& plan)
    : plan_(plan),
      photos_(CacheBytes(plan) / 5,
              [this](int view) { return ReadPhoto(plan_.views[view]); }),
      depth_maps_(CacheBytes(plan) * 4 / 5,
                  [this](int view) { return ReadDepth(view); }) {}

Map<float> ProblemReader::ReadDepth(int view) const {
  const std::string path =
      plan_.MapPath(MapKind::kDepth, view, Pass::kPhotometric);
  CheckMapFile(path, MapKind::kDepth, plan_.views[view].width,
               plan_.views[view].height);
  return ReadDepthMap(path);
}

Map<Vec3> ProblemReader::ReadNormal(int view) const {
  const std::string path =
      plan_.MapPath(MapKind::kNormal, view, Pass::kPhotometric);
  CheckMapFile(path, MapKind::kNormal, plan_.views[view].width,
               plan_.views[view].height);
  return ReadNormalMap(path);
}

bool ProblemReader::ReadPhotos(const std::function<bool()>& stopped) {
  std::set<int> needed;
  for (const PassPlan& pass : plan_.passes) {
    for (size_t i = 0; i < plan_.problems.size(); ++i) {
      if (!pass.is_done[i]) {
        const ViewIndices& problem = plan_.problems[i];
        needed.insert(problem.reference);
        needed.insert(problem.sources.begin(), problem.sources.end());
      }
    }
  }
  for (const int view : needed) {
    if (stopped()) {
      return false;
    }
    photos_.Get(view);
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
    view.camera = plan_.views[index].camera;
    input->photos.push_back(photos_.Get(index));
    view.image = input->photos.back().get();
    return view;
  };

  const SceneView& reference = plan_.views[problem.reference];
  const bool is_geometric = pass.pass == Pass::kGeometric;
  Problem& to = input->problem;
  to.reference = to_view(problem.reference);
  for (const int source : problem.sources) {
    if (stopped()) {
      return nullptr;
    }
    to.sources.push_back(to_view(source));
    if (is_geometric) {
      input->depth_maps.push_back(depth_maps_.Get(source));
      to.sources.back().depth = input->depth_maps.back().get();
    }
  }
  if (is_geometric) {
    to.depth = *depth_maps_.Get(problem.reference);
    to.normal = ReadNormal(problem.reference);
  }
  if (pass.options.tapa.enabled) {
    input->color = ReadColorPhoto(reference);
    to.reference_color = &*input->color;
  }
  const bool has_range = pass.options.depth_min >= 0;
  to.depth_min = has_range ? pass.options.depth_min : reference.depth_min;
  to.depth_max = has_range ? pass.options.depth_max : reference.depth_max;
  return input;
}

}  // namespace tapa
