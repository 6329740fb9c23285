#include "src/mvs/backend.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "src/mvs/cpu/parallel.h"
#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/cpu/sweep.h"

namespace tapa {
namespace {

// Number of lines that a thread takes at a time: eight, for neighbouring
// columns share cache lines, but fewer where they would take so long that a
// request to stop had to wait.
int LinesPerBlock(const ProblemData& data, int line_length) {
  constexpr double kMaxSamples = 1e8;
  constexpr double kMaxLines = 8;
  const double samples_per_line = static_cast<double>(line_length) *
                                  data.window.num_samples *
                                  (data.num_sources + 15);
  return static_cast<int>(
      std::clamp(kMaxSamples / samples_per_line, 1.0, kMaxLines));
}

class CpuBackend : public Backend {
 public:
  CpuBackend(const Options& options, const Problem& problem)
      : data_(options, problem),
        state_(data_, options.filter),
        team_(EffectiveNumThreads(options.num_threads)) {
    for (int i = 0; i < team_.size(); ++i) {
      scratch_.push_back(std::make_unique<SweepScratch>(data_));
    }
  }

  bool SetEstimate(Map<float> depth, Map<Vec3> normal,
                   const More& more) override {
    state_.depth = std::move(depth);
    state_.normal = std::move(normal);
    return team_.For(
        data_.height, LinesPerBlock(data_, data_.width),
        [&](int thread, int begin, int end) {
          ComputeCosts(data_, begin, end, &state_, scratch_[thread].get());
        },
        more);
  }

  bool Sweep(const SweepParams& params, const More& more) override {
    const auto direction = static_cast<Direction>(params.index % 4);
    const int num_lines = NumLines(data_, direction);
    const int length = num_lines == data_.width ? data_.height : data_.width;
    return team_.For(
        num_lines, LinesPerBlock(data_, length),
        [&](int thread, int begin, int end) {
          SweepLines(data_, params, direction, begin, end, &state_,
                     scratch_[thread].get());
        },
        more);
  }

  Estimate TakeResult() override {
    return {std::move(state_.depth), std::move(state_.normal),
            std::move(state_.prob), std::move(state_.consistent)};
  }

 private:
  ProblemData data_;
  SweepState state_;
  ThreadTeam team_;
  std::vector<std::unique_ptr<SweepScratch>> scratch_;
};

}  // namespace

std::unique_ptr<Backend> MakeCpuBackend(const Options& options,
                                        const Problem& problem) {
  return std::make_unique<CpuBackend>(options, problem);
}

}  // namespace tapa
