#ifndef TAPA_SRC_MVS_CUDA_MEMORY_PLAN_H_
#define TAPA_SRC_MVS_CUDA_MEMORY_PLAN_H_

#include <cstddef>

#include "src/mvs/options.h"
#include "src/mvs/problem.h"

namespace tapa {

// Sizes of what the CUDA backend allocates, in elements, but for the planes of
// TAPA, which take some kilobytes.
struct MemoryPlan {
  MemoryPlan(const Options& options, const Problem& problem);

  // All of it in bytes.
  size_t Bytes() const;

  int width = 0;
  int height = 0;
  int num_views = 0;
  // Of the largest source view: all lie in layers of one texture.
  int max_source_width = 0;
  int max_source_height = 0;
  bool geometric = false;
  bool tapa = false;
  bool prior = false;
  // Pixels of a line whose backward messages are kept. With the one per piece
  // that is kept too, they are fewest at the square root of a line's length.
  int piece_length = 0;

  size_t pixels = 0;
  size_t pixel_views = 0;
  size_t source_pixels = 0;
  // Floats, for lines in either direction.
  size_t backward = 0;
  size_t checkpoints = 0;
  size_t forward = 0;
  // Planes.
  size_t previous = 0;
};

// Bytes of device memory that the CUDA backend needs. For n source views and a
// reference view, all of w x h pixels:
//
//   w h (8 + 4 n + 1)     estimate, costs and probabilities, reference image
//   w h n                 source images
//   4 w h n               their depth maps, in the geometric pass
//   6 w h                 with TAPA: textureness and planes
//   8 w h                 with a prior
//   about 8 n max(w, h)^1.5   messages on the way
//
// which makes 199 bytes per pixel at 20 views of 3200 x 2130, in the geometric
// pass with TAPA and without a prior. What CUDA itself takes comes on top.
size_t EstimateDepthDeviceMemory(const Options& options,
                                 const Problem& problem);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_MEMORY_PLAN_H_
