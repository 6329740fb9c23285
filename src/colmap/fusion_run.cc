#include "src/colmap/fusion_run.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include "mvs/fusion.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/fusion_input.h"
#include "src/colmap/fusion_source.h"
#include "src/colmap/interrupt.h"

namespace tapa {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

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
  double done = 0;
  control.progress = [&](double share) {
    done = share;
    return !is_stopped();
  };
  const auto begin = Clock::now();
  auto view_begin = begin;
  size_t num_views = 0;
  size_t num_points = 0;
  control.view_done = [&](const FusedView& view) {
    ++num_views;
    num_points += view.points.size();
    const double to_go = done > 0 ? SecondsSince(begin) * (1 / done - 1) : 0;
    std::printf(
        "Fused %zu/%zu %s in %.1f s: %zu points, %zu in all; %.0f s to "
        "go\n",
        num_views, problem.views.size(), source->Name(view.view).c_str(),
        SecondsSince(view_begin), view.points.size(), num_points, to_go);
    std::fflush(stdout);
    view_begin = Clock::now();
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
    FusionSource source(
        options,
        FusionLocation(workspace_path, workspace_format, pmvs_option_name),
        FusionPass(input_type));
    auto fused = std::make_shared<FusedCloud>();
    if (!FuseAndReport(options, &source, stopped, fused.get())) {
      std::cout << "Stopped; nothing was written." << std::endl;
      return interrupt.Signal() != 0 ? 128 + interrupt.Signal() : EXIT_FAILURE;
    }
    NumberAsModel(source, fused.get());
    if (fused->NumPoints() == 0) {
      ReportNoPoints(options);
      return EXIT_FAILURE;
    }
    std::cout << "Number of fused points: " << fused->NumPoints() << std::endl;
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
