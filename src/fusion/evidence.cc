#include "src/fusion/evidence.h"

#include <algorithm>
#include <cmath>

#include "src/fusion/packed_normal.h"

namespace tapa {
namespace {

// More views than this do not make a point any surer, so that it can still be
// doubted, and the other way round.
constexpr float kEnough = 3;
// What agrees less than this does not see the point.
constexpr float kVisible = 0.3f;
// A point off another's tangential plane by more than this share of its depth,
// or with a normal at a larger angle (25 degrees), is on another surface.
constexpr float kPlaneDistance = 0.003f;
constexpr float kNormalCosine = 0.9f;
// Places to look at on either side.
constexpr int kReach = 3;

}  // namespace

ViewEvidence::ViewEvidence(int width, int height)
    : agreement(width, height),
      precision(width, height),
      depth_offset(width, height),
      normal(width, height),
      doubt(width, height),
      visible(width, height),
      same(width, height) {}

void AskNeighbor(const ViewPair& pair, const SurfaceMap& view,
                 const SurfaceMap& other, int number, int begin, int end,
                 ViewEvidence* evidence) {
  const uint64_t bit = uint64_t{1} << number;
  for (int row = begin; row < end; ++row) {
    for (int col = 0; col < view.width(); ++col) {
      const float depth = view.At(row, col).depth;
      if (!IsDepth(depth)) {
        continue;
      }
      const Opinion opinion = pair.Ask(
          row, col, depth, UnpackNormal(view.At(row, col).normal), other);
      const float w = opinion.agreement;
      if (w > 0) {
        evidence->agreement.At(row, col) += w;
        const float precision = w * opinion.precision;
        evidence->precision.At(row, col) += precision;
        evidence->depth_offset.At(row, col) += precision * opinion.depth_offset;
        Vec3& n = evidence->normal.At(row, col);
        n = n + precision * opinion.normal;
      }
      evidence->doubt.At(row, col) += opinion.doubts;
      if (w > kVisible) {
        evidence->visible.At(row, col) |= bit;
      }
      if (opinion.is_same) {
        evidence->same.At(row, col) |= bit;
      }
    }
  }
}

void WeighEvidence(const ViewEvidence& evidence, double doubt, int begin,
                   int end, Map<float>* weight) {
  for (int row = begin; row < end; ++row) {
    for (int col = 0; col < weight->width(); ++col) {
      const float against =
          static_cast<float>(doubt) *
          std::min<float>(evidence.doubt.At(row, col), kEnough);
      weight->At(row, col) =
          std::min(evidence.agreement.At(row, col), kEnough) - against;
    }
  }
}

void SpreadEvidence(const Camera& camera, const SurfaceMap& view, int radius,
                    const Map<float>& weight, int begin, int end,
                    Map<float>* spread) {
  const IndexCamera rays(camera);
  const int step = std::max(1, radius / kReach);
  const int width = weight.width();
  const int height = weight.height();
  for (int row = begin; row < end; ++row) {
    for (int col = 0; col < width; ++col) {
      float& result = spread->At(row, col);
      result = weight.At(row, col);
      const float depth = view.At(row, col).depth;
      if (radius <= 0 || !IsDepth(depth)) {
        continue;
      }
      const Vec3 normal = UnpackNormal(view.At(row, col).normal);
      const float plane = depth * Dot(normal, rays.Ray(col, row));
      float sum = 0;
      int count = 0;
      for (int i = -kReach; i <= kReach; ++i) {
        const int r = row + i * step;
        if (r < 0 || r >= height) {
          continue;
        }
        for (int j = -kReach; j <= kReach; ++j) {
          const int c = col + j * step;
          if (c < 0 || c >= width || (i == 0 && j == 0)) {
            continue;
          }
          const float d = view.At(r, c).depth;
          if (IsDepth(d) &&
              std::abs(d * Dot(normal, rays.Ray(c, r)) - plane) <
                  kPlaneDistance * depth &&
              Dot(normal, UnpackNormal(view.At(r, c).normal)) > kNormalCosine) {
            sum += weight.At(r, c);
            ++count;
          }
        }
      }
      if (count > 0) {
        result += sum / count;
      }
    }
  }
}

}  // namespace tapa
