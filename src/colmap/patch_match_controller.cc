// The implementation of COLMAP's mvs/patch_match.h. Upstream's, which needs
// CUDA, is not compiled.

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <utility>

#include "mvs/patch_match.h"
#include "src/base/failure.h"
#include "src/base/machine_limits.h"
#include "src/base/parallel.h"
#include "src/base/peak_memory.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/folder_lock.h"
#include "src/colmap/interrupt.h"
#include "src/colmap/option_list.h"
#include "src/colmap/run_part.h"
#include "src/colmap/stereo_plan.h"
#include "src/colmap/stereo_run.h"
#include "src/colmap/workers.h"
#include "src/mvs/device_trial.h"
#include "util/misc.h"

namespace colmap {
namespace mvs {

void PatchMatchOptions::Print() const {
  PrintHeading2("PatchMatchOptions");
  tapa::VisitOptions(this,
                     [](const tapa::OptionEntry& entry, const auto* value) {
                       std::cout << entry.name << ": " << *value << std::endl;
                     });
}

PatchMatchController::PatchMatchController(const PatchMatchOptions& options,
                                           const std::string& workspace_path,
                                           const std::string& workspace_format,
                                           const std::string& pmvs_option_name,
                                           const std::string& config_path)
    : options_(options),
      workspace_path_(workspace_path),
      workspace_format_(workspace_format),
      pmvs_option_name_(pmvs_option_name),
      config_path_(config_path) {}

void PatchMatchController::Run() {
  PrintHeading1("Dense stereo");
  options_.Print();
  std::cout << std::endl;

  tapa::WorkspaceLocation location;
  location.path = workspace_path_;
  location.format = workspace_format_;
  location.pmvs_option_name = pmvs_option_name_;
  location.config_path = config_path_;

  const tapa::Interrupt interrupt;
  const auto stopped = [&] { return interrupt.Signal() != 0 || IsStopped(); };
  exit_status_ = EXIT_FAILURE;
  try {
    const tapa::FolderLock lock(workspace_path_,
                                tapa::RunPart(options_).IsWorker()
                                    ? tapa::FolderLock::Use::kShared
                                    : tapa::FolderLock::Use::kAlone);
    tapa::StereoPlan plan = tapa::MakeStereoPlan(options_, location);
    tapa::MachineLimits limits = tapa::FindMachineLimits();
    limits.num_cpus = tapa::EffectiveNumThreads(options_.num_threads);
    const tapa::Workers workers = tapa::ChooseWorkers(
        options_.use_gpu, options_.gpu_index, tapa::FindDevices(),
        [&](int device) {
          std::cout << "Trying GPU " << device << " with a small test ..."
                    << std::endl;
          return tapa::TryDevice(device, tapa::EngineOptions(options_),
                                 stopped);
        },
        limits, plan.MaxMegapixels());
    if (!workers.message.empty()) {
      std::cout << workers.message << std::endl;
    }
    tapa::StereoRun run(std::move(plan), workers.devices, stopped, listener_);
    if (run.Run()) {
      exit_status_ = EXIT_SUCCESS;
    } else {
      if (interrupt.Signal() != 0) {
        exit_status_ = 128 + interrupt.Signal();
      }
      std::cout << "Stopped with " << run.NumDone() << " of " << run.NumViews()
                << " views complete; start it again to go on from there."
                << std::endl;
    }
  } catch (const std::bad_alloc&) {
    tapa::PrintError(
        "There is not enough memory; lower --PatchMatchStereo.max_image_size "
        "or cache_size");
  } catch (const std::exception& error) {
    tapa::PrintError(error.what());
  }
  GetTimer().PrintMinutes();
  std::cout << tapa::DescribePeakMemory() << std::endl;
}

}  // namespace mvs
}  // namespace colmap
