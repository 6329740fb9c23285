#include "src/mvs/cpu/problem_data.h"

#include "src/mvs/sweep/consistency_mask.h"

namespace tapa {

ProblemData::ProblemData(const Options& options, const Problem& problem)
    : width(problem.reference.image->width()),
      height(problem.reference.image->height()),
      num_sources(static_cast<int>(problem.sources.size())),
      window(options),
      reference(*problem.reference.image, window),
      cameras(problem) {
  for (const View& view : problem.sources) {
    sources.emplace_back(*view.image);
    if (options.geom_consistency) {
      source_depths.push_back(view.depth == nullptr
                                  ? DepthView{nullptr, 0, 0}
                                  : DepthView{view.depth->data(),
                                              view.depth->width(),
                                              view.depth->height()});
    }
  }
}

SweepState::SweepState(const ProblemData& data, bool with_mask)
    : cost(data.NumPixels() * data.num_sources),
      prob(data.NumPixels() * data.num_sources),
      consistent(with_mask
                     ? data.NumPixels() * ConsistencyMaskBytes(data.num_sources)
                     : 0) {}

}  // namespace tapa
