#include <memory>
#include <utility>
#include <vector>

#include "src/base/parallel.h"
#include "src/mvs/backends.h"
#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/cpu/sweep.h"

namespace tapa {
namespace {

// Number of lines that a thread takes at a time: neighbouring columns share
// cache lines.
constexpr int kLinesPerBlock = 8;

class CpuBackend : public Backend {
 public:
  CpuBackend(const Options& options, const Problem& problem)
      : data_(options, problem),
        state_(data_, options.filter || options.tapa.enabled),
        team_(EffectiveNumThreads(options.num_threads)) {
    if (options.tapa.enabled) {
      state_.chosen = Map<uint8_t>(data_.width, data_.height);
    }
    guide_.weight_range = static_cast<float>(options.tapa.weight_range);
    guide_.depth_min = problem.depth_min;
    guide_.depth_max = problem.depth_max;
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
    const auto direction = static_cast<Direction>(params.index % 4);
    return team_.For(
        NumLines(data_, direction), kLinesPerBlock,
        [&](int thread, int begin, int end,
            const ContinueCheck& should_continue) {
          SweepLines(data_, params, guide_, direction, begin, end,
                     should_continue, &state_, scratch_[thread].get());
        },
        progress);
  }

  void SetTextureness(Map<float> textureness) override {
    guide_.textureness = std::move(textureness);
  }

  void SetPlanes(PlaneSet fine, PlaneSet coarse) override {
    guide_.fine = std::move(fine);
    guide_.coarse = std::move(coarse);
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
  SweepGuide guide_;
  ThreadTeam team_;
  std::vector<std::unique_ptr<SweepScratch>> scratch_;
};

}  // namespace

std::unique_ptr<Backend> MakeCpuBackend(const Options& options,
                                        const Problem& problem) {
  return std::make_unique<CpuBackend>(options, problem);
}

}  // namespace tapa
