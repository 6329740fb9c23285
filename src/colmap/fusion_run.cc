#include "src/colmap/fusion_run.h"

#include <chrono>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include "mvs/fusion.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/folder_lock.h"
#include "src/colmap/fusion_input.h"
#include "src/colmap/fusion_source.h"
#include "src/colmap/interrupt.h"
#include "src/colmap/terminal_line.h"
#include "util/string.h"

namespace tapa {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// Tells the user how far a fusion is: a line per view and, on a terminal, one
// that is renewed in place.
class FusionProgress {
 public:
  explicit FusionProgress(size_t num_views) : num_views_(num_views) {}

  void Update(double share) {
    constexpr double kInterval = 0.3;
    share_ = share;
    if (SecondsSince(last_update_) > kInterval) {
      last_update_ = Clock::now();
      line_.Show(
          TimeToGo(share, SecondsSince(begin_)) +
          colmap::StringPrintf("  fusing %zu/%zu", num_fused_ + 1, num_views_));
    }
  }

  void EndView(const std::string& name, size_t num_points) {
    ++num_fused_;
    num_points_ += num_points;
    const double to_go =
        share_ > 0 ? SecondsSince(begin_) * (1 / share_ - 1) : 0;
    line_.Clear();
    std::cout << colmap::StringPrintf(
                     "Fused %zu/%zu %s in %.1f s: %zu points, %zu in all; %.0f "
                     "s to go",
                     num_fused_, num_views_, name.c_str(),
                     SecondsSince(view_begin_), num_points, num_points_, to_go)
              << std::endl;
    view_begin_ = last_update_ = Clock::now();
  }

 private:
  const size_t num_views_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point view_begin_ = begin_;
  Clock::time_point last_update_ = begin_;
  double share_ = 0;
  size_t num_fused_ = 0;
  size_t num_points_ = 0;
  TerminalLine line_;
};

void PrintOptions(const colmap::mvs::StereoFusionOptions& options) {
  colmap::PrintHeading2("StereoFusion::Options");
  VisitFusionOptions(&options.agreement,
                     [](const OptionEntry& entry, const auto* value) {
                       std::cout << entry.name << ": " << *value << std::endl;
                     });
  std::cout << "mask_path: " << options.mask_path << std::endl
            << "max_image_size: " << options.max_image_size << std::endl
            << "num_threads: " << options.num_threads << std::endl
            << std::endl;
}

// Views by their index in the model, as files have them.
void NumberAsModel(const FusionSource& source, FusedCloud* cloud) {
  for (FusedView& view : cloud->views) {
    view.view = source.ModelIndex(view.view);
    for (int& neighbor : view.neighbors) {
      neighbor = source.ModelIndex(neighbor);
    }
  }
}

// Returns whether it came to its end.
bool FuseAndReport(const colmap::mvs::StereoFusionOptions& options,
                   FusionSource* source,
                   const std::function<bool()>& is_stopped, FusedCloud* cloud) {
  const FusionProblem problem = source->Problem();
  FusionControl control;
  control.num_threads = options.num_threads;
  FusionProgress progress(problem.views.size());
  control.progress = [&](double share) {
    progress.Update(share);
    return !is_stopped();
  };
  control.view_done = [&](const FusedView& view) {
    progress.EndView(source->Name(view.view), view.points.size());
  };
  return Fuse(options.agreement, problem, control, cloud);
}

}  // namespace

int FuseWorkspace(const colmap::mvs::StereoFusionOptions& options,
                  const std::string& workspace_path,
                  const std::string& workspace_format,
                  const std::string& pmvs_option_name,
                  const std::string& input_type,
                  const std::function<bool()>& is_stopped,
                  std::shared_ptr<const FusedCloud>* cloud,
                  Eigen::Vector3d* origin) {
  PrintOptions(options);
  const Interrupt interrupt;
  const auto stopped = [&] { return interrupt.Signal() != 0 || is_stopped(); };
  try {
    CheckFusionOptions(options.agreement);
    const FolderLock lock(workspace_path, FolderLock::Use::kShared);
    FusionSource source(
        options,
        FusionLocation(workspace_path, workspace_format, pmvs_option_name),
        FusionPass(input_type));
    auto fused = std::make_shared<FusedCloud>();
    fused->max_bytes_in_memory = FusionSource::PointBytes(options);
    fused->folder = workspace_path;
    if (!FuseAndReport(options, &source, stopped, fused.get())) {
      std::cout << "Stopped; nothing was written." << std::endl;
      return interrupt.Signal() != 0 ? 128 + interrupt.Signal() : EXIT_FAILURE;
    }
    NumberAsModel(source, fused.get());
    if (fused->NumPoints() == 0) {
      ReportNoPoints(options);
      return EXIT_FAILURE;
    }
    std::cout << "Number of fused points: " << fused->NumPoints() << std::endl
              << source.DescribeCacheUse() << std::endl;
    *cloud = fused;
    *origin = source.Origin();
    return EXIT_SUCCESS;
  } catch (const std::bad_alloc&) {
    PrintError(
        "There is not enough memory; lower --StereoFusion.max_image_size or "
        "agreement_cache_size");
  } catch (const std::exception& error) {
    PrintError(error.what());
  }
  return EXIT_FAILURE;
}

}  // namespace tapa
