#include "src/mvs/tapa/consensus.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "src/base/depth.h"
#include "src/base/parallel.h"
#include "src/mvs/tapa/jury.h"

namespace tapa {
namespace {

// Votes that a source view's surface needs to take a pixel: as many as a
// triangle (triangle_completion.h).
constexpr int kMinLead = 3;

// Source views whose surfaces are in memory at a time.
int NumAtATime(const Options& options, int num_members) {
  return std::min(EffectiveNumThreads(options.num_threads), num_members);
}

// What a surface has at a pixel or, where points of a view that is further away
// lie too far apart, beside it: whether it is seen there votes tell.
float NearestAround(const Map<float>& surface, int row, int col) {
  float nearest = surface.At(row, col);
  if (nearest > 0) {
    return nearest;
  }
  for (int r = std::max(row - 1, 0);
       r <= std::min(row + 1, surface.height() - 1); ++r) {
    for (int c = std::max(col - 1, 0);
         c <= std::min(col + 1, surface.width() - 1); ++c) {
      const float z = surface.At(r, c);
      if (z > 0 && !(nearest > 0 && nearest <= z)) {
        nearest = z;
      }
    }
  }
  return nearest;
}

// Runs steps over rows or members with several threads, and tells how far all
// of them together are.
class Steps {
 public:
  using Run = std::function<void(int index, const ContinueCheck&)>;

  // total: number of indices of all steps.
  Steps(int num_threads, int total, const Control& control)
      : team_(num_threads), total_(total), control_(control) {}

  // Returns false if stopped.
  bool For(int count, const Run& run) {
    const auto block = [&run](int, int begin, int end,
                              const ContinueCheck& should_continue) {
      for (int i = begin; i < end && should_continue(); ++i) {
        run(i, should_continue);
      }
    };
    const auto progress = [&](double share) {
      if (control_.progress) {
        control_.progress((done_ + share * count) / total_);
      }
      return !control_.IsStopped();
    };
    const bool is_complete = team_.For(count, 1, block, progress);
    done_ += count;
    return is_complete;
  }

 private:
  ThreadTeam team_;
  const double total_;
  const Control& control_;
  int done_ = 0;
};

// The pixels of a view that are outvoted, or have no estimate, and what they
// become.
class Verdict {
 public:
  Verdict(const Problem& problem, const Jury& jury, int width, int height)
      : problem_(problem),
        jury_(jury),
        lead_(width, height, kUnasked),
        depth_(width, height),
        member_(width, height) {}

  void FindOutvoted(int row, const Map<float>& depth) {
    for (int col = 0; col < depth.width(); ++col) {
      const float own = depth.At(row, col);
      const bool is_masked =
          problem_.IsMasked(static_cast<size_t>(row) * depth.width() + col);
      if (!is_masked && !(IsDepth(own) && jury_.Lead(row, col, own, 0) >= 0)) {
        lead_.At(row, col) = kMinLead - 1;
      }
    }
  }

  // surfaces: of the members from `first` on.
  void ChooseBest(int row, int first, const std::vector<Map<float>>& surfaces) {
    for (int col = 0; col < lead_.width(); ++col) {
      int16_t& best = lead_.At(row, col);
      for (size_t i = 0; i < surfaces.size() && best != kUnasked; ++i) {
        const float z = NearestAround(surfaces[i], row, col);
        const int lead = IsDepth(z) ? jury_.Lead(row, col, z, best + 1) : 0;
        if (lead > best) {
          best = static_cast<int16_t>(lead);
          depth_.At(row, col) = z;
          member_.At(row, col) = static_cast<int16_t>(first + i);
        }
      }
    }
  }

  void Execute(int row, Map<float>* depth, Map<Vec3>* normal) const {
    for (int col = 0; col < depth->width(); ++col) {
      if (lead_.At(row, col) == kUnasked) {
        continue;
      }
      const float taken = depth_.At(row, col);
      const DepthNormal plane =
          taken > 0 ? jury_.PlaneOf(member_.At(row, col), row, col, taken)
                    : DepthNormal();
      depth->At(row, col) = plane.depth;
      normal->At(row, col) = plane.normal;
    }
  }

 private:
  static constexpr int16_t kUnasked = INT16_MAX;

  const Problem& problem_;
  const Jury& jury_;
  // Of the best surface so far; kUnasked: the pixel keeps its estimate.
  Map<int16_t> lead_;
  // The depth of that surface, if it has at least kMinLead votes, and the
  // member that has it; 0: none yet.
  Map<float> depth_;
  Map<int16_t> member_;
};

}  // namespace

bool ReachConsensus(const Options& options, const Problem& problem,
                    const Control& control, Map<float>* depth,
                    Map<Vec3>* normal) {
  const int width = depth->width();
  const int height = depth->height();
  const Jury jury(options, problem);
  if (jury.size() == 0) {
    return !control.IsStopped();
  }
  const int at_a_time = NumAtATime(options, jury.size());
  const int num_rounds = (jury.size() + at_a_time - 1) / at_a_time;
  Steps steps(EffectiveNumThreads(options.num_threads),
              2 * height + jury.size() + num_rounds * height, control);

  Verdict verdict(problem, jury, width, height);
  if (!steps.For(height, [&](int row, const ContinueCheck&) {
        verdict.FindOutvoted(row, *depth);
      })) {
    return false;
  }
  for (int first = 0; first < jury.size(); first += at_a_time) {
    std::vector<Map<float>> surfaces(std::min(at_a_time, jury.size() - first),
                                     Map<float>(width, height));
    const auto project = [&](int i, const ContinueCheck& should_continue) {
      jury.Project(first + i, should_continue, &surfaces[i]);
    };
    const auto choose = [&](int row, const ContinueCheck&) {
      verdict.ChooseBest(row, first, surfaces);
    };
    if (!steps.For(static_cast<int>(surfaces.size()), project) ||
        !steps.For(height, choose)) {
      return false;
    }
  }
  return steps.For(height, [&](int row, const ContinueCheck&) {
    verdict.Execute(row, depth, normal);
  });
}

size_t ConsensusMemory(const Options& options, const Problem& problem,
                       int width, int height) {
  const int num_surfaces =
      NumAtATime(options, static_cast<int>(problem.sources.size()));
  size_t bytes = (sizeof(float) + sizeof(Vec3) + 2 * sizeof(int16_t) +
                  sizeof(float) * (1 + num_surfaces)) *
                 width * height;
  for (const View& view : problem.sources) {
    bytes += view.depth == nullptr ? 0 : view.depth->size() * sizeof(float);
  }
  return bytes;
}

}  // namespace tapa
