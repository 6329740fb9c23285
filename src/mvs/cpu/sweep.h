#ifndef TAPA_SRC_MVS_CPU_SWEEP_H_
#define TAPA_SRC_MVS_CPU_SWEEP_H_

#include <array>
#include <vector>

#include "src/base/progress.h"
#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/sweep/hypotheses.h"
#include "src/mvs/sweep/pixel_scratch.h"
#include "src/mvs/sweep/sweep_params.h"

namespace tapa {

// Working memory of one thread. Stays where it is: `pixel` points into it.
class SweepScratch {
 public:
  explicit SweepScratch(const ProblemData& data);
  SweepScratch(const SweepScratch&) = delete;
  SweepScratch& operator=(const SweepScratch&) = delete;

  Patch patch;
  PixelScratch pixel;
  // Backward messages of a whole line, padded_count for each pixel.
  hwy::AlignedFreeUniquePtr<float[]> backward;

 private:
  hwy::AlignedFreeUniquePtr<float[]> arrays_;
  std::vector<int> order_;
  std::vector<Projection> projection_;
  std::array<float, kDrawBlock> uniform_;
  std::array<DepthNormal, kNumHypotheses> hypotheses_;
  std::array<Vec3, kNumHypotheses> homographies_;
  std::array<float, kNumHypotheses> sums_;
};

// Sweeps along lines [begin, end). Different lines may be swept at the same
// time. This function and the next call should_continue every few milliseconds
// and return before they are done once it returns false.
void SweepLines(const ProblemData& data, const SweepParams& params,
                const SweepGuide<float>& guide, int begin, int end,
                const ContinueCheck& should_continue, SweepState* state,
                SweepScratch* scratch);

// Computes the photometric costs of the state's estimates in rows [begin, end)
// and sets their selection probabilities to one half.
void ComputeCosts(const ProblemData& data, int begin, int end,
                  const ContinueCheck& should_continue, SweepState* state,
                  SweepScratch* scratch);

// The two steps of a photometric cost, for tests and benchmarks: the patch
// around a reference pixel, and its correlation with source view m.
void PreparePatch(const ProblemData& data, int row, int col, Patch* patch);
float PhotometricCost(const ProblemData& data, const Patch& patch,
                      const Warp& warp, int m);

// Instruction set that the functions above run with on this machine.
const char* InstructionSet();

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CPU_SWEEP_H_
