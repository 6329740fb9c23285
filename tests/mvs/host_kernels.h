#ifndef TAPA_TESTS_MVS_HOST_KERNELS_H_
#define TAPA_TESTS_MVS_HOST_KERNELS_H_

#include <vector>

#include "src/mvs/camera_table.h"
#include "src/mvs/cpu/problem_data.h"
#include "src/mvs/cuda/host_textures.h"
#include "src/mvs/cuda/host_warp.h"
#include "src/mvs/cuda/lanes.h"
#include "src/mvs/cuda/sweep_body.h"

namespace tapa {

// What the CUDA backend's kernels do, run on the host: every template instance
// of them is Lanes (a warp's or SerialLanes), Sizes (src/mvs/cuda/layout.h) and
// whether textures are precise.
template <class Lanes, class Sizes, bool kPrecise>
class HostKernels {
 public:
  // piece_length: pixels of a line that are swept at a time. order: of the
  // lanes' turns, see HostWarp.
  HostKernels(const Options& options, const Problem& problem,
              int piece_length = 16, uint32_t order = 0)
      : problem_(problem),
        textures_(problem_),
        cameras_(problem),
        order_(order) {
    const Map<uint8_t>& image = *problem.reference.image;
    const int width = image.width();
    const int height = image.height();
    const int longer = std::max(width, height);
    const size_t n = problem.sources.size();
    task_.width = width;
    task_.height = height;
    task_.num_views = static_cast<int>(n);
    task_.window = WindowShape::FromOptions(options);
    task_.camera = cameras_.reference();
    task_.piece_length = piece_length;
    task_.depth_min = problem.depth_min;
    task_.depth_max = problem.depth_max;

    // Nobody may read what was not written before: it is not a number.
    constexpr float kUnset = NAN;
    planes_.resize(image.size());
    cost_.assign(image.size() * n, 0xABCD);
    prob_.assign(image.size() * n, 0xABCD);
    const int num_pieces = (longer + piece_length - 1) / piece_length;
    checkpoints_.assign(num_pieces * longer * n, kUnset);
    backward_.assign(longer * piece_length * n, kUnset);
    forward_.assign(longer * n, kUnset);
    previous_.resize(longer);
    words_.assign(ScratchWords<Lanes, Sizes>(task_.window, task_.num_views),
                  kUnset);
    task_.planes = planes_.data();
    task_.cost = cost_.data();
    task_.prob = prob_.data();
    task_.checkpoints = checkpoints_.data();
    task_.backward = backward_.data();
    task_.forward = forward_.data();
    task_.previous = previous_.data();

    // Without padding, as in a kernel's shared memory.
    const int stride = Sizes::Stride(task_.num_views);
    camera_words_.assign(SourceCameras::kNumCoefficients * stride, kUnset);
    for (int i = 0; i < SourceCameras::kNumCoefficients; ++i) {
      for (size_t m = 0; m < n; ++m) {
        camera_words_[i * stride + m] =
            cameras_.coefficients()[i * cameras_.padded_count() + m];
      }
    }
    views_ = ArrangeCameras(camera_words_.data(), stride, task_.num_views,
                            task_.num_views);
  }

  void SetGuide(const SweepGuide& guide) {
    guide_ = guide;
    task_.weight_range = guide.weight_range;
    textureness_.resize(guide.textureness.size());
    for (size_t i = 0; i < textureness_.size(); ++i) {
      textureness_[i] = EncodeTextureness(guide.textureness.data()[i]);
    }
    task_.textureness = textureness_.empty() ? nullptr : textureness_.data();
    const auto table = [](const PlaneSet& set) {
      return PlaneTable{set.planes.data(),
                        set.index.empty() ? nullptr : set.index.data()};
    };
    task_.fine = table(guide_.fine);
    task_.coarse = table(guide_.coarse);
  }

  void SetEstimate(const Map<float>& depth, const Map<Vec3>& normal) {
    for (size_t i = 0; i < depth.size(); ++i) {
      planes_[i] = Pack({depth.data()[i], normal.data()[i]});
    }
    RunWarp([this] {
      for (int row = 0; row < task_.height; ++row) {
        for (int col = 0; col < task_.width; ++col) {
          InitializePixel<Lanes, Sizes>(task_, views_, textures_, row, col,
                                        words_.data());
        }
      }
    });
  }

  void Sweep(const SweepParams& params) {
    task_.params = params;
    for (int line = 0; line < task_.NumLines(); ++line) {
      RunWarp([&] {
        ComputeCheckpoints<Lanes>(task_, line);
        for (int piece = 0; piece < task_.NumPieces(); ++piece) {
          SweepPiece<Lanes, Sizes>(task_, views_, textures_, line, piece,
                                   words_.data());
        }
      });
    }
  }

  const std::vector<PackedPlane>& planes() const { return planes_; }
  const std::vector<uint16_t>& cost() const { return cost_; }
  const std::vector<uint16_t>& prob() const { return prob_; }

 private:
  template <class Body>
  void RunWarp(const Body& body) {
    if (Lanes::Step() == 1) {
      body();
    } else {
      HostWarp::Run(body, order_);
    }
  }

  const Problem problem_;
  const HostTextures<kPrecise> textures_;
  const CameraTable cameras_;
  const uint32_t order_;
  SweepTask task_;
  SourceCameras views_;
  SweepGuide guide_;
  std::vector<PackedPlane> planes_;
  std::vector<uint16_t> cost_;
  std::vector<uint16_t> prob_;
  std::vector<uint16_t> textureness_;
  std::vector<float> checkpoints_;
  std::vector<float> backward_;
  std::vector<float> forward_;
  std::vector<Plane> previous_;
  std::vector<float> camera_words_;
  std::vector<float> words_;
};

}  // namespace tapa

#endif  // TAPA_TESTS_MVS_HOST_KERNELS_H_
