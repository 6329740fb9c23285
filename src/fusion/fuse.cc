#include "src/fusion/fuse.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/base/parallel.h"
#include "src/fusion/evidence.h"
#include "src/fusion/packed_normal.h"
#include "src/fusion/used_pixels.h"
#include "src/fusion/view_order.h"
#include "src/fusion/view_pair.h"

namespace tapa {
namespace {

constexpr int kRowsPerBlock = 16;

// From the frame of a camera to the world's.
Vec3 TurnToWorld(const Camera& camera, const Vec3& v) {
  const auto& R = camera.R;
  return {static_cast<float>(R[0] * v.x + R[3] * v.y + R[6] * v.z),
          static_cast<float>(R[1] * v.x + R[4] * v.y + R[7] * v.z),
          static_cast<float>(R[2] * v.x + R[5] * v.y + R[8] * v.z)};
}

Vec3 PointInWorld(const Camera& camera, const Vec3& v) {
  const auto& R = camera.R;
  const double x = v.x - camera.t[0];
  const double y = v.y - camera.t[1];
  const double z = v.z - camera.t[2];
  return {static_cast<float>(R[0] * x + R[3] * y + R[6] * z),
          static_cast<float>(R[1] * x + R[4] * y + R[7] * z),
          static_cast<float>(R[2] * x + R[5] * y + R[8] * z)};
}

class Fusion {
 public:
  Fusion(const FusionOptions& options, const FusionProblem& problem,
         const FusionControl& control)
      : options_(options),
        limits_(options),
        problem_(problem),
        control_(control),
        team_(EffectiveNumThreads(control.num_threads)) {
    for (const FusionView& view : problem.views) {
      used_.push_back(std::make_unique<UsedPixels>(view.width, view.height));
      total_work_ += Work(view);
    }
  }

  bool Run(FusedCloud* cloud) {
    std::vector<std::vector<int>> neighbors;
    for (const FusionView& view : problem_.views) {
      neighbors.push_back(view.neighbors);
    }
    for (const int index : ViewOrder(neighbors)) {
      FusedView fused;
      fused.view = index;
      if (!FuseView(index, &fused)) {
        return false;
      }
      if (control_.view_done) {
        control_.view_done(fused);
      }
      cloud->Add(std::move(fused));
    }
    return true;
  }

 private:
  // Asking the neighbours, and all else.
  static double Work(const FusionView& view) {
    return static_cast<double>(view.width) * view.height *
           (view.neighbors.size() + 2);
  }

  // Runs for blocks of the rows of a view: run(begin, end). share: of the
  // view's work.
  template <typename Function>
  bool ForRows(const FusionView& view, double share, const Function& run) {
    const double work = share * view.width * view.height;
    const bool is_done = team_.For(
        view.height, kRowsPerBlock,
        [&](int, int begin, int end, const ContinueCheck&) { run(begin, end); },
        [&](double done) {
          return !control_.progress ||
                 control_.progress((done_work_ + done * work) / total_work_);
        });
    done_work_ += work;
    return is_done;
  }

  // Asks the neighbours of a view, each pair a view and one of them. Every
  // other view asks them from the last one on: those whose maps were read last
  // are then asked first, and are still in memory where not all fit.
  bool AskNeighbors(const FusionView& view, const SurfaceMap& surface,
                    const std::vector<ViewPair>& pairs,
                    ViewEvidence* evidence) {
    const int count = static_cast<int>(view.neighbors.size());
    for (int i = 0; i < count; ++i) {
      const int n = asks_backwards_ ? count - 1 - i : i;
      const int other = view.neighbors[n];
      const auto other_surface = problem_.read_surface(other);
      CheckSize(problem_.views[other], *other_surface);
      if (!ForRows(view, 1, [&](int begin, int end) {
            AskNeighbor(pairs[n], surface, *other_surface, n, begin, end,
                        evidence);
          })) {
        return false;
      }
    }
    asks_backwards_ = !asks_backwards_;
    return true;
  }

  bool FuseView(int index, FusedView* fused) {
    const FusionView& view = problem_.views[index];
    const SurfaceMap surface = WithoutUsed(index);
    ViewEvidence evidence(view.width, view.height);
    std::vector<ViewPair> pairs;
    for (const int other : view.neighbors) {
      pairs.emplace_back(view.camera, problem_.views[other].camera, limits_);
    }
    if (!AskNeighbors(view, surface, pairs, &evidence)) {
      return false;
    }

    const int radius = static_cast<int>(
        options_.spread * std::max(view.width, view.height) + 0.5);
    Map<float> weight(view.width, view.height);
    Map<float> spread(view.width, view.height);
    if (!ForRows(view, 0.2,
                 [&](int begin, int end) {
                   WeighEvidence(evidence, options_.doubt, begin, end, &weight);
                 }) ||
        !ForRows(view, 0.8, [&](int begin, int end) {
          SpreadEvidence(view.camera, surface, radius, weight, begin, end,
                         &spread);
        })) {
      return false;
    }

    const Map<Rgb> colors = problem_.read_colors(index);
    std::vector<std::vector<FusedPoint>> rows(view.height);
    if (!ForRows(view, 1, [&](int begin, int end) {
          for (int row = begin; row < end; ++row) {
            MakePoints(index, row, surface, evidence, spread, colors, pairs,
                       &rows[row]);
          }
        })) {
      return false;
    }
    fused->neighbors = view.neighbors;
    size_t count = 0;
    for (const auto& row : rows) {
      count += row.size();
    }
    fused->points.reserve(count);
    for (auto& row : rows) {
      fused->points.insert(fused->points.end(), row.begin(), row.end());
      std::vector<FusedPoint>().swap(row);  // Not all of them twice in memory.
    }
    return true;
  }

  // The maps of a view less the pixels that points of other views show already,
  // which need not be looked at.
  SurfaceMap WithoutUsed(int index) const {
    const auto whole_surface = problem_.read_surface(index);
    CheckSize(problem_.views[index], *whole_surface);
    SurfaceMap surface = *whole_surface;
    const UsedPixels& used = *used_[index];
    for (int row = 0; row < surface.height(); ++row) {
      for (int col = 0; col < surface.width(); ++col) {
        if (used.IsMarked(row, col)) {
          surface.At(row, col).depth = 0;
        }
      }
    }
    return surface;
  }

  static void CheckSize(const FusionView& view, const SurfaceMap& surface) {
    if (surface.width() != view.width || surface.height() != view.height) {
      throw std::invalid_argument("a map is not of its view's size");
    }
  }

  // Makes the points of a row and marks the pixels of other views that show the
  // same. Marks are made in other views only, and all end up set in whatever
  // order, so the result does not depend on threads.
  void MakePoints(int index, int row, const SurfaceMap& surface,
                  const ViewEvidence& evidence, const Map<float>& weight,
                  const Map<Rgb>& colors, const std::vector<ViewPair>& pairs,
                  std::vector<FusedPoint>* points) {
    const FusionView& view = problem_.views[index];
    const IndexCamera rays(view.camera);
    for (int col = 0; col < view.width; ++col) {
      const float depth = surface.At(row, col).depth;
      if (!IsDepth(depth) || weight.At(row, col) < options_.threshold) {
        continue;
      }
      // The pixel's own estimate counts as one view that agrees in full.
      const float views = 1 + evidence.precision.At(row, col);
      const float fused_depth =
          depth * (1 + evidence.depth_offset.At(row, col) / views);
      FusedPoint point;
      point.position =
          PointInWorld(view.camera, fused_depth * rays.Ray(col, row));
      if (problem_.is_wanted && !problem_.is_wanted(point.position)) {
        continue;
      }
      const Vec3 own_normal = UnpackNormal(surface.At(row, col).normal);
      const Vec3 normal = own_normal + evidence.normal.At(row, col);
      point.normal = PackNormal(TurnToWorld(view.camera, normal));
      point.color = colors.At(row, col);
      point.confidence = weight.At(row, col);
      point.visible = evidence.visible.At(row, col);
      points->push_back(point);
      MarkSame(view, row, col, depth, evidence.same.At(row, col), pairs);
    }
  }

  void MarkSame(const FusionView& view, int row, int col, float depth,
                uint64_t same, const std::vector<ViewPair>& pairs) {
    for (size_t n = 0; n < pairs.size(); ++n) {
      if (((same >> n) & 1) == 0) {
        continue;
      }
      const int other = view.neighbors[n];
      int other_row, other_col;
      Vec3 seen;
      if (pairs[n].Find(row, col, depth, problem_.views[other].width,
                        problem_.views[other].height, &other_row, &other_col,
                        &seen)) {
        used_[other]->Mark(other_row, other_col);
      }
    }
  }

  const FusionOptions& options_;
  const AgreementLimits limits_;
  const FusionProblem& problem_;
  const FusionControl& control_;
  ThreadTeam team_;
  std::vector<std::unique_ptr<UsedPixels>> used_;
  double total_work_ = 0;
  double done_work_ = 0;
  bool asks_backwards_ = false;
};

}  // namespace

bool Fuse(const FusionOptions& options, const FusionProblem& problem,
          const FusionControl& control, FusedCloud* cloud) {
  CheckFusionOptions(options);
  return Fusion(options, problem, control).Run(cloud);
}

}  // namespace tapa
