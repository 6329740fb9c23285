#include "src/mvs/tapa/triangle_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "src/base/depth.h"
#include "src/mvs/tapa/textureness.h"

namespace tapa {
namespace {

// Squares along the longest side.
constexpr int kNumSquares = 80;
// Of a pixel and the eight beside it.
constexpr int kMinNumClose = 7;
// A plane must be further from the camera than this share of the distance of
// its points, or its depths explode.
constexpr float kMinSlope = 0.02f;

// row, col: not at the border.
bool IsSmooth(const Map<float>& depth, int row, int col, float max_step) {
  const float z = depth.At(row, col);
  int num_close = 0;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = col - 1; c <= col + 1; ++c) {
      num_close += std::abs(depth.At(r, c) - z) <= max_step * z ? 1 : 0;
    }
  }
  return num_close >= kMinNumClose;
}

// Facing the camera. Returns whether there is one that can be seen.
bool PlaneThrough(const std::array<Vec3, 3>& points, Plane* plane) {
  const Vec3 u = points[1] - points[0];
  const Vec3 v = points[2] - points[0];
  const Vec3 cross = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z,
                      u.x * v.y - u.y * v.x};
  const float length = std::sqrt(Dot(cross, cross));
  if (!(length > 0)) {
    return false;
  }
  const float distance = -Dot(cross, points[0]) / length;
  const float sign = distance < 0 ? -1.0f : 1.0f;
  plane->normal = (sign / length) * cross;
  plane->distance = std::abs(distance);
  return plane->distance > kMinSlope * std::sqrt(Dot(points[0], points[0]));
}

// Triangles of indices of anchors.
std::vector<std::array<int, 3>> Delaunay(int width, int height,
                                         const std::vector<Anchor>& anchors) {
  cv::Subdiv2D subdivision(cv::Rect(0, 0, width, height));
  // OpenCV names corners by their places.
  std::map<std::pair<int, int>, int> anchor_at;
  for (size_t i = 0; i < anchors.size(); ++i) {
    const auto& [row, col] = anchors[i];
    subdivision.insert(
        cv::Point2f(static_cast<float>(col), static_cast<float>(row)));
    anchor_at.emplace(std::pair(row, col), static_cast<int>(i));
  }
  std::vector<cv::Vec6f> found;
  if (anchors.size() >= 3) {
    subdivision.getTriangleList(found);
  }
  const auto anchor = [&](float col, float row) {
    const auto at = anchor_at.find({static_cast<int>(std::lround(row)),
                                    static_cast<int>(std::lround(col))});
    return at == anchor_at.end() ? -1 : at->second;
  };
  std::vector<std::array<int, 3>> triangles;
  for (const cv::Vec6f& xy : found) {
    const std::array<int, 3> corners = {
        anchor(xy[0], xy[1]), anchor(xy[2], xy[3]), anchor(xy[4], xy[5])};
    // Triangles at the rim have corners outside of the image.
    if (*std::min_element(corners.begin(), corners.end()) >= 0) {
      triangles.push_back(corners);
    }
  }
  return triangles;
}

}  // namespace

int AnchorSpacing(int width, int height) {
  return std::max(4, (std::max(width, height) + kNumSquares - 1) / kNumSquares);
}

std::vector<Anchor> FindAnchors(const TapaOptions& options,
                                const Map<float>& depth,
                                const Map<float>& textureness,
                                double min_textureness) {
  const int height = depth.height() - 1;
  const int width = depth.width() - 1;
  const int size = AnchorSpacing(depth.width(), depth.height());
  // Half of what a plane may be off by.
  const float step = static_cast<float>(0.5 * options.relative_plane_distance);
  std::vector<Anchor> anchors;
  for (int top = 1; top < height; top += size) {
    for (int left = 1; left < width; left += size) {
      Anchor best = {-1, -1};
      float most = static_cast<float>(min_textureness);
      for (int row = top; row < std::min(top + size, height); ++row) {
        for (int col = left; col < std::min(left + size, width); ++col) {
          const float t = textureness.At(row, col);
          if (t >= most && IsDepth(depth.At(row, col)) &&
              IsSmooth(depth, row, col, step)) {
            most = t;
            best = {row, col};
          }
        }
      }
      if (best.row >= 0) {
        anchors.push_back(best);
      }
    }
  }
  return anchors;
}

std::vector<Anchor> FindAnchors(const TapaOptions& options, const View& view,
                                double min_textureness) {
  return FindAnchors(options, *view.depth,
                     ComputeTextureness(*view.image, TexturenessOf(options)),
                     min_textureness);
}

TrianglePlanes TriangulateAnchors(const RefCamera& camera,
                                  const Map<float>& depth,
                                  const std::vector<Anchor>& anchors) {
  TrianglePlanes result;
  for (const auto& [row, col] : anchors) {
    result.anchors.push_back(depth.At(row, col) * camera.Ray(row, col));
  }
  result.index =
      Map<int32_t>(depth.width(), depth.height(), TrianglePlanes::kNone);
  cv::Mat index(depth.height(), depth.width(), CV_32S, result.index.data());
  for (const std::array<int, 3>& corners :
       Delaunay(depth.width(), depth.height(), anchors)) {
    std::array<cv::Point, 3> pixels;
    std::array<Vec3, 3> points;
    for (int i = 0; i < 3; ++i) {
      pixels[i] = {anchors[corners[i]].col, anchors[corners[i]].row};
      points[i] = result.anchors[corners[i]];
    }
    Plane plane;
    if (PlaneThrough(points, &plane)) {
      cv::fillConvexPoly(index, pixels.data(), 3,
                         cv::Scalar(static_cast<double>(result.planes.size())));
      result.planes.push_back(plane);
      result.corners.push_back(corners);
    }
  }
  return result;
}

}  // namespace tapa
