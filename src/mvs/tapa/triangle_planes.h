#ifndef TAPA_SRC_MVS_TAPA_TRIANGLE_PLANES_H_
#define TAPA_SRC_MVS_TAPA_TRIANGLE_PLANES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "src/base/map.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/options.h"
#include "src/mvs/sweep/plane.h"

// Beyond TAPA-MVS: surfaces without texture as what lies between their edges,
// which have some. See docs/tapa.md for what it gains. The triangles between
// sparse points that can be trusted are those of Xu and Tao, "Planar Prior
// Assisted PatchMatch Multi-View Stereo", AAAI 2020.

namespace tapa {

// The planes of triangles that cover a view between its anchors.
struct TrianglePlanes {
  static constexpr int32_t kNone = -1;

  std::vector<Plane> planes;
  // Of each triangle the anchors at its corners, as indices.
  std::vector<std::array<int, 3>> corners;
  // In the frame of the camera.
  std::vector<Vec3> anchors;
  // The triangle of every pixel; kNone: none.
  Map<int32_t> index;

  // The plane of a pixel's triangle on the pixel's ray; depth 0: there is none.
  DepthNormal At(const RefCamera& camera, int row, int col) const {
    const int32_t triangle = index.At(row, col);
    return triangle == kNone ? DepthNormal()
                             : PlaneAt(planes[triangle], camera.Ray(row, col));
  }
};

// A pixel whose estimate texture supports.
struct Anchor {
  int row;
  int col;
};

// Textureness of anchors: deviations of eight grey levels with the default
// options, which edges have and shading has not.
constexpr double kClearTexture = 0.7;

// Side of the squares that have one anchor each, in pixels: 1/80 of the image's
// longest side, at least 4.
int AnchorSpacing(int width, int height);

// At most one in each square: of the pixels of at least a textureness whose
// depth most pixels beside them share, the one with most texture. Depth 0:
// there is no estimate.
std::vector<Anchor> FindAnchors(const TapaOptions& options,
                                const Map<float>& depth,
                                const Map<float>& textureness,
                                double min_textureness);

// The same of a view that has a depth map.
std::vector<Anchor> FindAnchors(const TapaOptions& options, const View& view,
                                double min_textureness);

// The planes of the Delaunay triangles between anchors, in the frame of the
// camera. Triangles seen edge-on have none.
TrianglePlanes TriangulateAnchors(const RefCamera& camera,
                                  const Map<float>& depth,
                                  const std::vector<Anchor>& anchors);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_TRIANGLE_PLANES_H_
