#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "src/mvs/backends.h"
#include "src/mvs/camera_table.h"
#include "src/mvs/cuda/kernels.h"
#include "src/mvs/cuda/memory.h"
#include "src/mvs/cuda/memory_plan.h"
#include "src/mvs/cuda/memory_share.h"
#include "src/mvs/cuda/problem_memory.h"
#include "src/mvs/device_error.h"
#include "src/mvs/sweep/consistency_mask.h"
#include "src/mvs/testing.h"

namespace tapa {
namespace {

// Lines are shared out among streams: while the last warps of one end a launch,
// those of others go on.
constexpr int kNumStreams = 4;
// Launches of a stream that wait in line while the host looks whether to
// continue.
constexpr int kQueueLength = 4;
// Rows whose first costs are computed before the host looks whether to
// continue.
constexpr int kRowsAtATime = 128;

KernelKind ChooseKernel(const Options& options, const CudaSwitches& switches,
                        int num_views) {
  const WindowShape window(options);
  const bool common = CommonSizes::Fits(window, num_views);
  if (switches.naive_kernel && !common) {
    throw std::invalid_argument(
        "the naive kernel is made for 6 by 6 samples and at most 32 views");
  }
  return switches.naive_kernel       ? KernelKind::kNaive
         : switches.precise_textures ? KernelKind::kPrecise
         : common                    ? KernelKind::kCommon
                                     : KernelKind::kAny;
}

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void DescribeDevice(int device, DeviceProfile* profile) {
  cudaDeviceProp properties;
  CheckCuda(cudaGetDeviceProperties(&properties, device),
            "asking for the GPU's properties");
  int kilohertz = 0;
  CheckCuda(cudaDeviceGetAttribute(&kilohertz, cudaDevAttrClockRate, device),
            "asking for the GPU's clock");
  profile->name = properties.name;
  profile->num_multiprocessors = properties.multiProcessorCount;
  profile->clock_hz = 1e3 * kilohertz;
}

class CudaBackend : public BackendForTesting {
 public:
  CudaBackend(const Options& options, const Problem& problem,
              const CudaSwitches& switches)
      : profile_(switches.profile),
        plan_(options, problem),
        share_(options.device, plan_.Bytes()),
        textures_(problem, plan_),
        estimates_(plan_.pixels),
        cost_(plan_.pixel_views),
        prob_(plan_.pixel_views),
        backward_(plan_.backward),
        checkpoints_(plan_.checkpoints),
        forward_(plan_.forward),
        previous_(plan_.previous),
        cameras_(SourceCameras::kNumCoefficients * plan_.num_views),
        task_(MakeTask(options, problem)),
        launch_(task_, ChooseKernel(options, switches, plan_.num_views)) {
    if (plan_.tapa) {
      textureness_ = DeviceArray<uint16_t>(plan_.pixels);
      fine_ = DevicePlanes(plan_.pixels);
      coarse_ = DevicePlanes(plan_.pixels);
    }
    if (plan_.prior) {
      prior_ = DeviceArray<PackedDepthNormal>(plan_.pixels);
    }
    share_.Settle();
    UploadCameras(problem);
    if (profile_ != nullptr) {
      DescribeDevice(options.device, profile_);
      DescribeKernel(launch_, profile_);
    }
  }

  bool SetEstimate(Map<float> depth, Map<Vec3> normal,
                   const ProgressCallback& progress) override {
    std::vector<PackedDepthNormal> packed(plan_.pixels);
    task_.has_masked = false;
    for (size_t i = 0; i < packed.size(); ++i) {
      const bool is_masked = depth.data()[i] == 0;
      task_.has_masked = task_.has_masked || is_masked;
      packed[i] =
          is_masked ? PackNothing() : Pack({depth.data()[i], normal.data()[i]});
    }
    estimates_.Upload(packed.data(), packed.size());
    is_downloaded_ = false;
    const Clock::time_point begin = Clock::now();
    for (int row = 0; row < plan_.height; row += kRowsAtATime) {
      const int end = std::min(plan_.height, row + kRowsAtATime);
      ForStreams(row, end, [this](int first, int last, const Stream& stream) {
        LaunchInitialize(launch_, task_, textures_.objects(), first, last,
                         stream.get());
      });
      if (!ContinuesAfter(row / kRowsAtATime,
                          static_cast<double>(end) / plan_.height, progress)) {
        return false;
      }
    }
    WaitForAll();
    if (profile_ != nullptr) {
      profile_->initialize_seconds += SecondsSince(begin);
    }
    return true;
  }

  bool Sweep(const SweepParams& params,
             const ProgressCallback& progress) override {
    is_downloaded_ = false;
    task_.params = params;
    has_masks_ = params.check_consistency;
    Clock::time_point begin = Clock::now();
    const int num_lines = task_.NumLines();
    ForStreams(0, num_lines, [this](int first, int last, const Stream& stream) {
      LaunchCheckpoints(task_, first, last, stream.get());
    });
    if (profile_ != nullptr) {
      WaitForAll();
      profile_->checkpoint_seconds += SecondsSince(begin);
      begin = Clock::now();
    }
    const int num_pieces = task_.NumPieces();
    const int per_launch = PiecesPerLaunch(launch_, task_);
    for (int piece = 0; piece < num_pieces; piece += per_launch) {
      const int end = std::min(num_pieces, piece + per_launch);
      ForStreams(0, num_lines, [&](int first, int last, const Stream& stream) {
        LaunchSweepPieces(launch_, task_, textures_.objects(), piece, end,
                          first, last, stream.get());
      });
      if (!ContinuesAfter(piece / per_launch,
                          static_cast<double>(end) / num_pieces, progress)) {
        return false;
      }
    }
    WaitForAll();
    if (profile_ != nullptr) {
      profile_->sweep_seconds += SecondsSince(begin);
    }
    return true;
  }

  void SetTextureness(Map<float> textureness) override {
    std::vector<uint16_t> codes(textureness.size());
    std::transform(textureness.data(), textureness.data() + codes.size(),
                   codes.begin(), [](float t) { return EncodeTextureness(t); });
    textureness_.Upload(codes.data(), codes.size());
    task_.guide.textureness = codes.empty() ? nullptr : textureness_.data();
  }

  void SetDepthPrior(Map<PackedDepthNormal> prior) override {
    prior_.Upload(prior.data(), prior.size());
    task_.guide.depth_prior = prior_.data();
  }

  void SetPlanes(PlaneSet fine, PlaneSet coarse) override {
    fine_.Set(fine);
    coarse_.Set(coarse);
    task_.guide.fine = fine_.table();
    task_.guide.coarse = coarse_.table();
  }

  const Map<float>& Depth() override {
    DownloadEstimate();
    return depth_;
  }

  const Map<Vec3>& Normal() override {
    DownloadEstimate();
    return normal_;
  }

  std::vector<uint16_t> Costs() const override {
    std::vector<uint16_t> costs(plan_.pixel_views);
    cost_.Download(costs.data());
    return costs;
  }

  Estimate TakeResult() override {
    DownloadEstimate();
    Estimate estimate;
    estimate.depth = std::move(depth_);
    estimate.normal = std::move(normal_);
    estimate.selection_prob.resize(plan_.pixel_views);
    prob_.Download(estimate.selection_prob.data());
    if (has_masks_) {
      DownloadMasks(&estimate);
    }
    return estimate;
  }

 private:
  SweepTask MakeTask(const Options& options, const Problem& problem) const {
    SweepTask task;
    task.width = plan_.width;
    task.height = plan_.height;
    task.num_views = plan_.num_views;
    task.geometric = plan_.geometric;
    task.window = WindowShape(options);
    task.camera = CameraTable(problem).reference();
    task.cameras = cameras_.data();
    task.estimates = estimates_.data();
    task.cost = cost_.data();
    task.prob = prob_.data();
    task.guide.weight_range = static_cast<float>(options.tapa.weight_range);
    task.guide.depth_min = problem.depth_min;
    task.guide.depth_max = problem.depth_max;
    task.piece_length = plan_.piece_length;
    task.checkpoints = checkpoints_.data();
    task.backward = backward_.data();
    task.forward = forward_.data();
    task.previous = previous_.data();
    return task;
  }

  void UploadCameras(const Problem& problem) {
    const CameraTable table(problem);
    const int n = plan_.num_views;
    std::vector<float> coefficients;
    for (int i = 0; i < SourceCameras::kNumCoefficients; ++i) {
      const float* row = table.coefficients().data() + i * table.padded_count();
      coefficients.insert(coefficients.end(), row, row + n);
    }
    cameras_.Upload(coefficients.data(), coefficients.size());
  }

  // Calls run(first line, last line, stream) for every stream's share of lines
  // [begin, end).
  template <class Run>
  void ForStreams(int begin, int end, const Run& run) {
    const int count = end - begin;
    for (int i = 0; i < kNumStreams; ++i) {
      const int first = begin + count * i / kNumStreams;
      const int last = begin + count * (i + 1) / kNumStreams;
      if (first < last) {
        run(first, last, streams_[i]);
      }
    }
  }

  // After launch number `launch` of all streams: waits for the oldest of the
  // last kQueueLength, while the device works on the others, and asks whether
  // to continue.
  bool ContinuesAfter(int launch, double done,
                      const ProgressCallback& progress) {
    const int slot = launch % kQueueLength;
    for (int i = 0; i < kNumStreams; ++i) {
      events_[(slot + 1) % kQueueLength][i].Wait();
      events_[slot][i].Record(streams_[i]);
    }
    if (!progress(done)) {
      WaitForAll();
      return false;
    }
    return true;
  }

  // Asleep, as other threads need the CPU.
  void WaitForAll() {
    for (int i = 0; i < kNumStreams; ++i) {
      events_[0][i].Record(streams_[i]);
    }
    for (Event& event : events_[0]) {
      event.Wait();
    }
  }

  void DownloadEstimate() {
    if (is_downloaded_) {
      return;
    }
    std::vector<PackedDepthNormal> packed(plan_.pixels);
    estimates_.Download(packed.data());
    depth_ = Map<float>(plan_.width, plan_.height);
    normal_ = Map<Vec3>(plan_.width, plan_.height);
    for (size_t i = 0; i < packed.size(); ++i) {
      depth_.data()[i] = packed[i].depth;
      normal_.data()[i] = UnpackNormal(packed[i].normal);
    }
    is_downloaded_ = true;
  }

  // What the last sweep left where the costs were, see SweepTask::cost.
  void DownloadMasks(Estimate* estimate) const {
    const size_t n = plan_.num_views;
    const int mask_bytes = ConsistencyMaskBytes(plan_.num_views);
    UninitializedVector<uint16_t> cost(plan_.pixel_views);
    cost_.Download(cost.data());
    estimate->consistent.resize(plan_.pixels * mask_bytes);
    if (plan_.tapa) {
      estimate->chosen = Map<uint8_t>(plan_.width, plan_.height);
    }
    for (size_t i = 0; i < plan_.pixels; ++i) {
      const auto* bytes = reinterpret_cast<const uint8_t*>(cost.data() + i * n);
      std::memcpy(estimate->consistent.data() + i * mask_bytes, bytes,
                  mask_bytes);
      if (plan_.tapa) {
        estimate->chosen.data()[i] = bytes[mask_bytes];
      }
    }
  }

  DeviceProfile* const profile_;
  const MemoryPlan plan_;
  // Chooses the device for all that follows.
  MemoryShare share_;
  ProblemTextures textures_;
  DeviceArray<PackedDepthNormal> estimates_;
  DeviceArray<uint16_t> cost_;
  DeviceArray<uint16_t> prob_;
  DeviceArray<float> backward_;
  DeviceArray<float> checkpoints_;
  DeviceArray<float> forward_;
  DeviceArray<DepthNormal> previous_;
  DeviceArray<float> cameras_;
  DeviceArray<uint16_t> textureness_;
  DevicePlanes fine_;
  DevicePlanes coarse_;
  DeviceArray<PackedDepthNormal> prior_;
  SweepTask task_;
  KernelLaunch launch_;
  // Behind all that their work uses.
  Stream streams_[kNumStreams];
  Event events_[kQueueLength][kNumStreams];
  // Whether the last sweep left masks of consistent views.
  bool has_masks_ = false;
  // The estimate on the host, while it is that on the device.
  bool is_downloaded_ = false;
  Map<float> depth_;
  Map<Vec3> normal_;
};

}  // namespace

std::unique_ptr<BackendForTesting> MakeCudaBackendForTesting(
    const Options& options, const Problem& problem,
    const CudaSwitches& switches) {
  while (true) {
    // Asked before, as one may end between the error and the wait.
    const int num_ended = MemoryShare::NumEnded(options.device);
    try {
      return std::make_unique<CudaBackend>(options, problem, switches);
    } catch (const DeviceMemoryError&) {
      // Others of this program may have what is missing.
      if (!MemoryShare::WaitForEnd(options.device, num_ended)) {
        throw;
      }
    }
  }
}

std::unique_ptr<Backend> MakeCudaBackend(const Options& options,
                                         const Problem& problem) {
  return MakeCudaBackendForTesting(options, problem);
}

}  // namespace tapa
