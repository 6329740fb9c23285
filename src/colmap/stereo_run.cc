#include "src/colmap/stereo_run.h"

#include <algorithm>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/base/map_files.h"
#include "src/colmap/consistency_graph.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/tapa_debug.h"
#include "src/colmap/workers.h"
#include "src/mvs/device_error.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/tapa/consensus.h"
#include "src/mvs/tapa/stages.h"
#include "util/misc.h"

namespace tapa {
namespace {

double Megapixels(const SceneView& view) {
  return 1e-6 * view.width * view.height;
}

// What a view takes, in megapixels times iterations.
double Work(const PassPlan& pass, const SceneView& view) {
  // Next to an iteration on the CPU.
  constexpr double kJudging = 0.1;
  return Megapixels(view) *
         (pass.takes_drafts ? kJudging : pass.options.num_iterations);
}

// What is left to compute.
double TotalWork(const StereoPlan& plan) {
  double total = 0;
  for (const PassPlan& pass : plan.passes) {
    for (size_t i = 0; i < plan.problems.size(); ++i) {
      if (pass.Computes(i)) {
        total += Work(pass, plan.View(plan.problems[i].reference, pass.level));
      }
    }
  }
  return total;
}

// Takes out of the result what is beyond a range of depths that was asked for.
void DropOutside(const PassPlan& pass, Estimate* estimate) {
  const double min = pass.options.depth_min;
  const double max = pass.options.depth_max;
  if (min < 0 || !pass.options.filter) {
    return;
  }
  const size_t num_pixels = estimate->depth.size();
  const size_t mask_bytes = estimate->consistent.size() / num_pixels;
  for (size_t i = 0; i < num_pixels; ++i) {
    float& depth = estimate->depth.data()[i];
    if (depth < min || depth > max) {
      depth = 0;
      estimate->normal.data()[i] = {0, 0, 0};
      std::fill_n(estimate->consistent.begin() + i * mask_bytes, mask_bytes, 0);
    }
  }
}

[[noreturn]] void FailForMemory(const SceneView& view, size_t bytes) {
  throw Failure("View " + view.name + " needs about " +
                std::to_string(bytes >> 20) +
                " MB of memory; lower --PatchMatchStereo.max_image_size or "
                "cache_size");
}

}  // namespace

StereoRun::StereoRun(StereoPlan plan, std::vector<int> workers,
                     std::function<bool()> stopped, ProgressListener listener)
    : plan_(std::move(plan)),
      workers_(std::move(workers)),
      stopped_(std::move(stopped)),
      reader_(plan_),
      progress_(TotalWork(plan_), std::move(listener)),
      num_done_(plan_.NumDone()) {}

bool StereoRun::Run() {
  PrepareFolders();
  if (!reader_.ReadPhotos(stopped_)) {
    return false;
  }
  for (const PassPlan& pass : plan_.passes) {
    if (!plan_.part.IsWorker()) {
      WriteRecords(pass);
    }
    if (!plan_.part.IsPreparation() && !ComputePass(pass)) {
      return false;
    }
  }
  if (plan_.part.IsWhole()) {
    TidyUp();
  }
  progress_.PrintSummary();
  std::cout << reader_.DescribeCacheUse() << std::endl;
  return true;
}

// Finds out, before hours are spent, whether files can be written.
void StereoRun::PrepareFolders() const {
  if (plan_.drops_levels) {
    RemoveLevels(plan_.location);
  }
  std::set<std::string> map_folders;
  std::set<std::string> picture_folders;
  std::set<std::string> other_folders;
  for (const PassPlan& pass : plan_.passes) {
    for (size_t i = 0; i < plan_.problems.size(); ++i) {
      const int view = plan_.problems[i].reference;
      for (const MapKind kind :
           {MapKind::kDepth, MapKind::kNormal, MapKind::kConsistencyGraph}) {
        const bool writes =
            pass.Computes(i) &&
            (kind != MapKind::kConsistencyGraph || pass.writes_graphs);
        (writes ? map_folders : other_folders)
            .insert(colmap::GetParentDir(
                plan_.MapPath(kind, view, pass.pass, pass.level)));
      }
      if (pass.Computes(i) && plan_.Draws(pass, i)) {
        picture_folders.insert(
            PictureFolder(pass.options.tapa_debug, plan_.View(view, 0).name));
      }
    }
  }
  for (const std::string& folder : other_folders) {
    RemoveStaleTemporaries(folder);
  }
  for (const std::string& folder : map_folders) {
    PrepareFolder(folder, "maps");
  }
  for (const std::string& folder : picture_folders) {
    PrepareFolder(folder, "the pictures of tapa_debug");
  }
}

void StereoRun::TidyUp() const {
  RemoveLevels(plan_.location);
  std::set<std::string> folders;
  for (const ViewIndices& problem : plan_.problems) {
    for (const MapKind kind :
         {MapKind::kDepth, MapKind::kNormal, MapKind::kConsistencyGraph}) {
      folders.insert(colmap::GetParentDir(
          plan_.MapPath(kind, problem.reference, Pass::kPhotometric, 0)));
    }
  }
  std::for_each(folders.begin(), folders.end(), RemoveStaleTemporaries);
}

// A small image leaves most of a GPU idle: at coarse levels it gets more views
// at a time, while the CPU has all of its threads at work on one.
std::vector<int> StereoRun::WorkersOf(const PassPlan& pass) const {
  // Views are judged on the CPU, each with all of its threads.
  if (pass.takes_drafts) {
    return {kCpu};
  }
  constexpr int kMaxTimes = 4;
  const int times = pass.level > 1 ? kMaxTimes : 1 << pass.level;
  std::vector<int> workers;
  for (const int device : workers_) {
    workers.insert(workers.end(), device == kCpu ? 1 : times, device);
  }
  return workers;
}

// Whether there is anything to do in a pass.
bool StereoRun::Computes(const PassPlan& pass) const {
  for (size_t i = 0; i < plan_.problems.size(); ++i) {
    if (pass.Computes(i)) {
      return true;
    }
  }
  return false;
}

void StereoRun::WriteRecords(const PassPlan& pass) const {
  if (!pass.has_maps && Computes(pass)) {
    WriteOptionsRecord(plan_.location.RecordPath(pass.pass, pass.level),
                       pass.record);
  }
  if (Computes(pass)) {
    WriteViewsRecord(plan_.location.ViewsRecordPath(pass.pass, pass.level),
                     pass.views_record);
  }
}

bool StereoRun::ComputePass(const PassPlan& pass) {
  std::atomic<size_t> next(0);
  std::exception_ptr error;
  const auto work = [&](int device) {
    while (!halted_ && !LeavesViewsToOthers(device)) {
      const size_t i = next++;
      if (i >= plan_.problems.size()) {
        break;
      }
      try {
        if (Stopped() || !ComputeProblem(i, pass, device)) {
          halted_ = true;
        }
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        error = error ? error : std::current_exception();
        halted_ = true;
      }
    }
  };
  // The calling thread is the first worker.
  const std::vector<int> workers = WorkersOf(pass);
  std::vector<std::thread> others;
  for (size_t i = 1; i < workers.size(); ++i) {
    try {
      others.emplace_back(work, workers[i]);
    } catch (const std::system_error&) {
      break;  // Those that could be started share out its views.
    }
  }
  work(workers[0]);
  for (std::thread& other : others) {
    other.join();
  }
  // What was left to others that did not come to it.
  work(kCpu);
  if (halted_) {
    progress_.ClearLine();
  }
  if (error) {
    std::rethrow_exception(error);
  }
  return !halted_;
}

bool StereoRun::ComputeProblem(size_t number, const PassPlan& pass,
                               int device) {
  if (!pass.Computes(number)) {
    return true;
  }
  const ViewIndices& problem = plan_.problems[number];
  const SceneView& view = plan_.View(problem.reference, pass.level);
  const int progress_view = progress_.BeginView(
      {pass.pass, pass.level,
       std::to_string(number + 1) + "/" + std::to_string(plan_.problems.size()),
       view.name, Megapixels(view), Work(pass, view)});
  if (!ComputeView(
          {pass, problem, view, plan_.Draws(pass, number), progress_view},
          device)) {
    return false;
  }
  progress_.EndView(progress_view);
  num_done_ += &pass == &plan_.passes.back();
  return true;
}

bool StereoRun::ComputeView(const Task& task, int device) {
  if (device == kCpu) {
    return ComputeViewOn(kCpu, task);
  }
  const std::string gpu = "GPU " + std::to_string(device);
  if (!IsLost(device)) {
    try {
      return ComputeViewOn(device, task);
    } catch (const DeviceLimitError& error) {
      progress_.ClearLine();
      PrintWarning("View " + task.view.name + " cannot be computed on " + gpu +
                   " (" + error.what() + "): the CPU is used for it");
    } catch (const DeviceError& error) {
      GiveUp(device, gpu + " failed at view " + task.view.name + " (" +
                         error.what() + ")");
    }
    progress_.Update(task.progress_view, 0);
  }
  const std::lock_guard<std::mutex> turn(cpu_mutex_);
  return ComputeViewOn(kCpu, task);
}

bool StereoRun::ComputeViewOn(int device, const Task& task) {
  if (task.pass.takes_drafts) {
    return JudgeView(task);
  }
  const auto stopped = [this] { return Stopped(); };
  Options options = EngineOptions(task.pass.options);
  options.seed = ViewSeed(task.pass.options.seed, task.view.name,
                          task.pass.pass, task.pass.level);
  options.device = device;
  const std::unique_ptr<ProblemInput> input =
      reader_.Read(task.problem, task.pass, stopped);
  if (input == nullptr) {
    return false;
  }

  Control control;
  control.progress = [&](double share) {
    progress_.Update(task.progress_view, share);
  };
  control.stopped = stopped;
  TapaRecord record;
  if (task.draws) {
    control.record = &record;
  }
  const size_t memory = EstimateDepthMemory(options, input->problem);
  std::optional<Estimate> estimate;
  try {
    estimate = EstimateDepth(options, std::move(input->problem), control);
  } catch (const std::invalid_argument& error) {
    throw Failure("View " + task.view.name +
                  " cannot be computed: " + error.what());
  } catch (const std::bad_alloc&) {
    FailForMemory(task.view, memory);
  }
  if (!estimate) {
    return false;
  }
  DropOutside(task.pass, &*estimate);
  // Before the maps, so that a run that is cut off here draws them again.
  if (task.draws) {
    TapaView view;
    view.title = task.view.name;
    view.photograph = &*input->color;
    view.record = &record;
    view.depth = &estimate->depth;
    view.normal = &estimate->normal;
    view.min_textureness =
        static_cast<float>(task.pass.options.tapa.min_textureness);
    RemoveTapaPictures(
        PictureFolder(task.pass.options.tapa_debug, task.view.name));
    if (!WritePictures(task, [&view] { return DrawTapaPictures(view); })) {
      return false;
    }
  }
  WriteView(task, *estimate, ConsistencyGraph(*estimate, task.problem.sources));
  return true;
}

bool StereoRun::JudgeView(const Task& task) {
  const auto stopped = [this] { return Stopped(); };
  const std::unique_ptr<ProblemInput> input =
      reader_.ReadDrafts(task.problem, task.pass, stopped);
  if (input == nullptr) {
    return false;
  }
  const Options options = EngineOptions(task.pass.options);
  Control control;
  control.progress = [&](double share) {
    progress_.Update(task.progress_view, share);
  };
  control.stopped = stopped;
  const Map<float> draft = std::move(input->problem.depth);
  Estimate estimate;
  estimate.normal = std::move(input->problem.normal);
  try {
    estimate.depth = draft;
    if (!ReachConsensus(options, input->problem, control, &estimate.depth,
                        &estimate.normal)) {
      return false;
    }
  } catch (const std::bad_alloc&) {
    FailForMemory(task.view, ConsensusMemory(options, input->problem,
                                             draft.width(), draft.height()));
  }
  DropOutside(task.pass, &estimate);
  const auto draw = [&] {
    return DrawFinalPictures(draft, estimate.depth, estimate.normal);
  };
  if (task.draws && !WritePictures(task, draw)) {
    return false;
  }
  std::vector<int32_t> graph;
  if (task.pass.writes_graphs) {
    graph = KeepUnchanged(
        ReadGraph(plan_.MapPath(MapKind::kConsistencyGraph,
                                task.problem.reference, Pass::kDraft, 0)),
        draft, estimate.depth);
  }
  WriteView(task, estimate, graph);
  return true;
}

// One at a time, as they take memory.
bool StereoRun::WritePictures(
    const Task& task, const std::function<std::vector<NamedPicture>()>& draw) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !Stopped() &&
         WriteTapaPictures(
             draw(),
             PictureFolder(task.pass.options.tapa_debug, task.view.name),
             [this] { return Stopped(); });
}

void StereoRun::WriteView(const Task& task, const Estimate& estimate,
                          const std::vector<int32_t>& graph) const {
  const auto path = [&](MapKind kind) {
    return plan_.MapPath(kind, task.problem.reference, task.pass.pass,
                         task.pass.level);
  };
  WriteDepthMap(path(MapKind::kDepth), estimate.depth);
  WriteNormalMap(path(MapKind::kNormal), estimate.normal);
  if (task.pass.writes_graphs) {
    WriteGraph(path(MapKind::kConsistencyGraph), task.view.width,
               task.view.height, graph);
  }
}

bool StereoRun::IsLost(int device) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return lost_devices_.count(device) > 0;
}

bool StereoRun::LeavesViewsToOthers(int device) {
  const auto works = [this](int other) {
    return other != kCpu && !IsLost(other);
  };
  return IsLost(device) && std::any_of(workers_.begin(), workers_.end(), works);
}

void StereoRun::GiveUp(int device, const std::string& why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (lost_devices_.insert(device).second) {
    progress_.ClearLine();
    PrintWarning(why + ": from now on the CPU is used in its place");
  }
}

}  // namespace tapa
