#ifndef TAPA_SRC_MVS_TAPA_SUPERPIXELS_H_
#define TAPA_SRC_MVS_TAPA_SUPERPIXELS_H_

#include <cstdint>
#include <vector>

#include "src/base/map.h"

namespace tapa {

// A superpixel that shares a border with another one.
struct Neighbor {
  int index = 0;
  // Bhattacharyya coefficient of the two colour histograms, 0 to 1.
  float similarity = 0;
};

// Segmentation of an image into regions of similar colour.
struct Superpixels {
  // 0 to neighbors.size() - 1 for every pixel; every label occurs.
  Map<uint16_t> labels;
  // Of each superpixel, by ascending index.
  std::vector<std::vector<Neighbor>> neighbors;

  int count() const { return static_cast<int>(neighbors.size()); }
};

// Segments an image into about num_superpixels regions by SEEDS (Van den Bergh
// et al., "SEEDS: Superpixels Extracted via Energy-Driven Sampling", IJCV
// 2015), as section 4.1 of TAPA-MVS asks. OpenCV's implementation rounds to
// grids of blocks: it makes at most as many as asked, two thirds to three
// quarters in most cases and on small images far fewer; of fewer than ten
// asked, sometimes more. Regions are at least 8 pixels wide and high on
// average, so an image with less room gets fewer; an image of less than 16
// pixels either way, or of a shape that SEEDS cannot do, is one region. An
// empty image has none. Deterministic.
Superpixels ComputeSuperpixels(const Map<Rgb>& image, int num_superpixels);

// Which superpixels touch, and how alike they are: Bhattacharyya coefficient of
// histograms with 8 bins per channel. `labels` are 0 to count - 1.
std::vector<std::vector<Neighbor>> FindNeighbors(const Map<Rgb>& image,
                                                 const Map<uint16_t>& labels,
                                                 int count);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_TAPA_SUPERPIXELS_H_
