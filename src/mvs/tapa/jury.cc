#include "src/mvs/tapa/jury.h"

#include <algorithm>
#include <cmath>

#include "src/base/depth.h"
#include "src/mvs/depth_planes.h"
#include "src/mvs/sweep/geometric_cost.h"
#include "src/mvs/tapa/nearest_pixel.h"

namespace tapa {

Jury::Jury(const Options& options, const Problem& problem)
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

int Jury::Lead(int row, int col, float depth, int least) const {
  int lead = 0;
  int num_left = size();
  for (const Member& member : members_) {
    if (lead + num_left < least) {
      return least - 1;
    }
    lead += Vote(member, row, col, depth);
    --num_left;
  }
  return lead;
}

int Jury::Vote(const Member& member, int row, int col, float depth) const {
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

// The pixel of a member that sees the point at a depth of a pixel, and the
// point's depth there; false: it has no estimate of such a pixel.
bool Jury::FindPixel(const Member& member, int row, int col, float depth,
                     float* z, int* own_row, int* own_col) const {
  const Vec3 p = TransferPoint(views_.A, views_.b, member.m, col, row, depth);
  *z = p.z;
  return p.z > 0 &&
         FindNearestPixel({p.x / p.z, p.y / p.z}, member.depth->width(),
                          member.depth->height(), own_row, own_col) &&
         IsDepth(member.depth->At(*own_row, *own_col));
}

void Jury::Project(int member, const ContinueCheck& should_continue,
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
      if (p.z > 0 && FindNearestPixel({p.x / p.z, p.y / p.z}, surface->width(),
                                      surface->height(), &ref_row, &ref_col)) {
        float& at = surface->At(ref_row, ref_col);
        at = at > 0 ? std::min(at, p.z) : p.z;
      }
    }
  }
}

DepthNormal Jury::PlaneOf(int member, int row, int col, float depth) const {
  const Member& from = members_[member];
  const Vec3 ray = reference_.Ray(row, col);
  const DepthNormal frontal = {depth, (-1 / std::sqrt(Dot(ray, ray))) * ray};
  float z;
  int own_row, own_col;
  if (!FindPixel(from, row, col, depth, &z, &own_row, &own_col)) {
    return frontal;
  }
  const DepthNormal own = DepthPlanes(*from.depth, from.camera,
                                      from.depth->width(), from.depth->height())
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

// The point of a member's plane at a pixel beside the plane's, in the frame of
// the reference camera.
Vec3 Jury::PointOn(const Member& member, const DepthNormal& plane, int row,
                   int col, int down, int right) const {
  const float depth =
      PropagateDepth(plane, member.camera.Ray(row, col),
                     member.camera.Ray(row + down, col + right));
  const Vec3 p = TransferPoint(views_.B, views_.g, member.m, col + right,
                               row + down, depth);
  return p.z * reference_.Ray(p.y / p.z, p.x / p.z);
}

}  // namespace tapa
