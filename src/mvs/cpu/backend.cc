#include <memory>
#include <utility>
#include <vector>

#include "src/base/parallel.h"
#include "src/mvs/backends.h"
#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/cpu/sweep.h"
#include "src/mvs/schedule.h"
#include "src/mvs/testing.h"

namespace tapa {
namespace {

// Number of lines that a thread takes at a time: neighbouring columns share
// cache lines.
constexpr int kLinesPerBlock = 8;

class CpuBackend : public BackendForTesting {
 public:
  CpuBackend(const Options& options, const Problem& problem)
      : data_(options, problem),
        state_(data_, Schedule::ChecksConsistency(options)),
        team_(EffectiveNumThreads(options.num_threads)) {
    if (options.tapa.enabled) {
      state_.chosen = Map<uint8_t>(data_.width, data_.height);
    }
    guide_maps_.weight_range = static_cast<float>(options.tapa.weight_range);
    guide_maps_.depth_min = problem.depth_min;
    guide_maps_.depth_max = problem.depth_max;
    for (int i = 0; i < team_.size(); ++i) {
      scratch_.push_back(std::make_unique<SweepScratch>(data_));
    }
  }

  bool SetEstimate(Map<float> depth, Map<Vec3> normal,
                   const ProgressCallback& progress) override {
    state_.depth = std::move(depth);
    state_.normal = std::move(normal);
    return team_.For(
        data_.height, kLinesPerBlock,
        [&](int thread, int begin, int end,
            const ContinueCheck& should_continue) {
          ComputeCosts(data_, begin, end, should_continue, &state_,
                       scratch_[thread].get());
        },
        progress);
  }

  bool Sweep(const SweepParams& params,
             const ProgressCallback& progress) override {
    const SweepGuide<float> guide = guide_maps_.Guide();
    return team_.For(
        NumLines(params.SweepDirection(), data_.width, data_.height),
        kLinesPerBlock,
        [&](int thread, int begin, int end,
            const ContinueCheck& should_continue) {
          SweepLines(data_, params, guide, begin, end, should_continue, &state_,
                     scratch_[thread].get());
        },
        progress);
  }

  void SetTextureness(Map<float> textureness) override {
    guide_maps_.textureness = std::move(textureness);
  }

  void SetDepthPrior(Map<PackedDepthNormal> prior) override {
    guide_maps_.depth_prior = std::move(prior);
  }

  void SetPlanes(PlaneSet fine, PlaneSet coarse) override {
    guide_maps_.fine = std::move(fine);
    guide_maps_.coarse = std::move(coarse);
  }

  const Map<float>& Depth() override { return state_.depth; }
  const Map<Vec3>& Normal() override { return state_.normal; }

  std::vector<uint16_t> Costs() const override {
    return {state_.cost.begin(), state_.cost.end()};
  }

  Estimate TakeResult() override {
    return {std::move(state_.depth), std::move(state_.normal),
            std::move(state_.prob), std::move(state_.consistent),
            std::move(state_.chosen)};
  }

 private:
  ProblemData data_;
  SweepState state_;
  GuideMaps guide_maps_;
  ThreadTeam team_;
  std::vector<std::unique_ptr<SweepScratch>> scratch_;
};

}  // namespace

std::unique_ptr<BackendForTesting> MakeCpuBackendForTesting(
    const Options& options, const Problem& problem) {
  return std::make_unique<CpuBackend>(options, problem);
}

std::unique_ptr<Backend> MakeCpuBackend(const Options& options,
                                        const Problem& problem) {
  return MakeCpuBackendForTesting(options, problem);
}

}  // namespace tapa
