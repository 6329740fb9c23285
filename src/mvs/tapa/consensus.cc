#include "src/mvs/tapa/consensus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "src/base/depth.h"
#include "src/base/parallel.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/depth_planes.h"
#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/tapa/nearest_pixel.h"

namespace tapa {
namespace {

// Votes that a source view's surface needs to take a pixel: as many as a
// triangle (triangle_completion.h). Other than there, one against counts once:
// here it takes an estimate away, and not only in favour of a triangle.
constexpr int kMinLead = 3;

// The source views that have a depth map.
class Jury {
 public:
  Jury(const Options& options, const Problem& problem)
      : table_(problem),
        views_(table_.sources()),
        reference_(table_.reference()),
        tolerance_(static_cast<float>(options.tapa.relative_plane_distance)) {
    for (int m = 0; m < views_.count; ++m) {
      const View& view = problem.sources[m];
      if (view.depth != nullptr) {
        members_.push_back({m, view.depth, MakeRefCamera(view.camera)});
      }
    }
  }

  int size() const { return static_cast<int>(members_.size()); }

  // Votes for a surface less those against it.
  int Lead(int row, int col, float depth) const {
    int lead = 0;
    for (const Member& member : members_) {
      lead += Vote(member, row, col, depth);
    }
    return lead;
  }

  // The nearest surface of a member on the ray of every pixel of the reference
  // view, 0 where it has none: the map's size is the view's.
  void Project(int member, const ContinueCheck& should_continue,
               Map<float>* surface) const {
    const Map<float>& depth = *members_[member].depth;
    for (int row = 0; row < depth.height() && should_continue(); ++row) {
      for (int col = 0; col < depth.width(); ++col) {
        const float z = depth.At(row, col);
        if (!IsDepth(z)) {
          continue;
        }
        const Vec3 p =
            TransferPoint(views_.B, views_.g, members_[member].m, col, row, z);
        int ref_row, ref_col;
        if (p.z > 0 &&
            FindNearestPixel({p.x / p.z, p.y / p.z}, surface->width(),
                             surface->height(), &ref_row, &ref_col)) {
          float& at = surface->At(ref_row, ref_col);
          at = at > 0 ? std::min(at, p.z) : p.z;
        }
      }
    }
  }

  // The plane of the surface that a member has at a depth of a pixel, on the
  // pixel's ray: the point that it has there is up to half a pixel beside it.
  DepthNormal PlaneOf(int member, int row, int col, float depth) const {
    const Member& from = members_[member];
    const Vec3 ray = reference_.Ray(row, col);
    const DepthNormal frontal = {depth, (-1 / std::sqrt(Dot(ray, ray))) * ray};
    float z;
    int own_row, own_col;
    if (!FindPixel(from, row, col, depth, &z, &own_row, &own_col)) {
      return frontal;
    }
    const DepthNormal own =
        DepthPlanes(*from.depth, from.camera, from.depth->width(),
                    from.depth->height())
            .At(own_row, own_col);
    // Three points of it, in the order of the camera's axes.
    constexpr int kStep = 8;
    const Vec3 a = PointOn(from, own, own_row, own_col, 0, 0);
    const Vec3 b = PointOn(from, own, own_row, own_col, 0, kStep);
    const Vec3 c = PointOn(from, own, own_row, own_col, kStep, 0);
    const Vec3 across = Cross(c - a, b - a);
    const Vec3 normal = (1 / std::sqrt(Dot(across, across))) * across;
    const float on_ray = Dot(normal, a) / Dot(normal, ray);
    const bool is_seen =
        Dot(normal, ray) < 0 && std::abs(on_ray - depth) <= tolerance_ * depth;
    return is_seen ? DepthNormal{on_ray, normal} : frontal;
  }

 private:
  struct Member {
    // Its number among the source views.
    int m;
    const Map<float>* depth;
    RefCamera camera;
  };

  // The point of a member's plane at a pixel beside the plane's, in the frame
  // of the reference camera.
  Vec3 PointOn(const Member& member, const DepthNormal& plane, int row, int col,
               int down, int right) const {
    const float depth =
        PropagateDepth(plane, member.camera.Ray(row, col),
                       member.camera.Ray(row + down, col + right));
    const Vec3 p = TransferPoint(views_.B, views_.g, member.m, col + right,
                                 row + down, depth);
    return p.z * reference_.Ray(p.y / p.z, p.x / p.z);
  }

  // The pixel of a member that sees the point at a depth of a pixel, and the
  // point's depth there; false: it has no estimate of such a pixel.
  bool FindPixel(const Member& member, int row, int col, float depth, float* z,
                 int* own_row, int* own_col) const {
    const Vec3 p = TransferPoint(views_.A, views_.b, member.m, col, row, depth);
    *z = p.z;
    return p.z > 0 &&
           FindNearestPixel({p.x / p.z, p.y / p.z}, member.depth->width(),
                            member.depth->height(), own_row, own_col) &&
           IsDepth(member.depth->At(*own_row, *own_col));
  }

  int Vote(const Member& member, int row, int col, float depth) const {
    float z;
    int own_row, own_col;
    if (!FindPixel(member, row, col, depth, &z, &own_row, &own_col)) {
      return 0;
    }
    const float error = member.depth->At(own_row, own_col) / z - 1;
    if (std::abs(error) <= tolerance_) {
      return 1;
    }
    return error > 2 * tolerance_ ? -1 : 0;
  }

  const CameraTable table_;
  const SourceCameras views_;
  const RefCamera reference_;
  const float tolerance_;
  std::vector<Member> members_;
};

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

// What pixels that are outvoted, or have no estimate, become.
struct Verdict {
  static constexpr int16_t kUnasked = INT16_MAX;

  // Lead of the best surface so far; kUnasked: the pixel keeps its estimate.
  Map<int16_t> lead;
  // The depth of that surface, if it has at least kMinLead votes, and the
  // member that has it; 0: none yet.
  Map<float> depth;
  Map<int16_t> member;
};

void ExecuteRow(const Verdict& verdict, const Jury& jury, int row,
                Map<float>* depth, Map<Vec3>* normal) {
  for (int col = 0; col < depth->width(); ++col) {
    if (verdict.lead.At(row, col) == Verdict::kUnasked) {
      continue;
    }
    const float taken = verdict.depth.At(row, col);
    const DepthNormal plane =
        taken > 0 ? jury.PlaneOf(verdict.member.At(row, col), row, col, taken)
                  : DepthNormal();
    depth->At(row, col) = plane.depth;
    normal->At(row, col) = plane.normal;
  }
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

int NumAtATime(const Options& options, int num_members) {
  return std::min(EffectiveNumThreads(options.num_threads), num_members);
}

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

  Verdict verdict{Map<int16_t>(width, height, Verdict::kUnasked),
                  Map<float>(width, height), Map<int16_t>(width, height)};
  const auto ask = [&](int row, const ContinueCheck&) {
    for (int col = 0; col < width; ++col) {
      const float own = depth->At(row, col);
      if (!problem.IsMasked(static_cast<size_t>(row) * width + col) &&
          !(IsDepth(own) && jury.Lead(row, col, own) >= 0)) {
        verdict.lead.At(row, col) = kMinLead - 1;
      }
    }
  };
  if (!steps.For(height, ask)) {
    return false;
  }
  for (int first = 0; first < jury.size(); first += at_a_time) {
    std::vector<Map<float>> surfaces(std::min(at_a_time, jury.size() - first),
                                     Map<float>(width, height));
    const auto project = [&](int i, const ContinueCheck& should_continue) {
      jury.Project(first + i, should_continue, &surfaces[i]);
    };
    const auto choose = [&](int row, const ContinueCheck&) {
      for (int col = 0; col < width; ++col) {
        int16_t& best = verdict.lead.At(row, col);
        for (size_t i = 0; i < surfaces.size(); ++i) {
          const float z = NearestAround(surfaces[i], row, col);
          if (best == Verdict::kUnasked || !IsDepth(z)) {
            continue;
          }
          const int lead = jury.Lead(row, col, z);
          if (lead > best) {
            best = static_cast<int16_t>(lead);
            verdict.depth.At(row, col) = z;
            verdict.member.At(row, col) = static_cast<int16_t>(first + i);
          }
        }
      }
    };
    if (!steps.For(static_cast<int>(surfaces.size()), project) ||
        !steps.For(height, choose)) {
      return false;
    }
  }
  return steps.For(height, [&](int row, const ContinueCheck&) {
    ExecuteRow(verdict, jury, row, depth, normal);
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
