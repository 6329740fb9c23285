#ifndef TAPA_SRC_MVS_CUDA_PROBLEM_MEMORY_H_
#define TAPA_SRC_MVS_CUDA_PROBLEM_MEMORY_H_

#include "src/mvs/cuda/kernels.h"
#include "src/mvs/cuda/memory.h"
#include "src/mvs/cuda/memory_plan.h"
#include "src/mvs/plane_set.h"

// What comes from the host, in device memory.

namespace tapa {

// The images of a problem as textures.
class ProblemTextures {
 public:
  ProblemTextures(const Problem& problem, const MemoryPlan& plan)
      : reference_(plan.width, plan.height, 0),
        sources_(plan.max_source_width, plan.max_source_height,
                 plan.num_views) {
    reference_.Upload(*problem.reference.image, 0);
    if (plan.geometric) {
      depths_ = DeviceImage<float>(plan.max_source_width,
                                   plan.max_source_height, plan.num_views);
      depth_texture_ = Texture(depths_.array(), Reading::kNearest);
    }
    for (int m = 0; m < plan.num_views; ++m) {
      sources_.Upload(*problem.sources[m].image, m);
      if (plan.geometric) {
        depths_.Upload(*problem.sources[m].depth, m);
      }
    }
    reference_texture_ = Texture(reference_.array(), Reading::kNearest);
    source_texture_ = Texture(sources_.array(), Reading::kBilinear);
    exact_source_texture_ = Texture(sources_.array(), Reading::kNearest);
  }

  TextureObjects objects() const {
    return {reference_texture_.object(), source_texture_.object(),
            exact_source_texture_.object(), depth_texture_.object()};
  }

 private:
  // Textures go before the images that they read.
  DeviceImage<uint8_t> reference_;
  DeviceImage<uint8_t> sources_;
  DeviceImage<float> depths_;
  Texture reference_texture_;
  Texture source_texture_;
  Texture exact_source_texture_;
  Texture depth_texture_;
};

// A PlaneSet in device memory.
class DevicePlanes {
 public:
  DevicePlanes() = default;
  explicit DevicePlanes(size_t num_pixels) : index_(num_pixels) {}

  void Set(const PlaneSet& set) {
    is_set_ = !set.index.empty();
    if (!is_set_) {
      return;
    }
    if (set.planes.size() > planes_.size()) {
      planes_ = DeviceArray<Plane>(set.planes.size());
    }
    planes_.Upload(set.planes.data(), set.planes.size());
    index_.Upload(set.index.data(), set.index.size());
  }

  PlaneTable table() const {
    return is_set_ ? PlaneTable{planes_.data(), index_.data()} : PlaneTable();
  }

 private:
  bool is_set_ = false;
  DeviceArray<Plane> planes_;
  DeviceArray<uint16_t> index_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_PROBLEM_MEMORY_H_
