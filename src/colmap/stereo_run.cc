#include "src/colmap/stereo_run.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <unordered_set>

#include "src/base/failure.h"
#include "src/colmap/consistency_graph.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/map_files.h"
#include "src/colmap/tapa_debug.h"
#include "src/colmap/workers.h"
#include "src/mvs/device_error.h"
#include "src/mvs/estimate_depth.h"
#include "src/mvs/tapa/stages.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::ExistsPath;
using colmap::mvs::PatchMatchOptions;

double Megapixels(const SceneView& view) {
  return 1e-6 * view.width * view.height;
}

Failure Damaged(const std::string& path, const std::string& error) {
  return Failure(path + " " + error +
                 "; remove it to have it computed again, or take the "
                 "max_image_size that it was computed with");
}

// Bytes that may be kept in memory of what can be read again: as the option
// says, but not more than half of the machine's memory.
double CacheBytes(double gigabytes) {
  const double memory = 1.0 * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
  return std::min(gigabytes * 1024 * 1024 * 1024, memory / 2);
}

void PrintWarning(const std::string& text) {
  std::cout << "WARNING: " << text << std::endl;
}

}  // namespace

StereoRun::StereoRun(const PatchMatchOptions& options,
                     const WorkspaceLocation& location,
                     std::vector<int> workers)
    : options_(options), location_(location), workers_(std::move(workers)) {}

bool StereoRun::Run(const std::function<bool()>& stopped) {
  if (!Prepare(stopped)) {
    return false;
  }

  double total = 0;
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    for (const ViewIndices& problem : problems_) {
      if (pass <= FinalPass(options_) && !IsDone(problem.reference, pass)) {
        total += Megapixels(views_[problem.reference]);
      }
    }
  }
  progress_ = std::make_unique<Progress>(total);

  if (FinalPass(options_) == Pass::kGeometric &&
      !ComputePass(Pass::kPhotometric, stopped)) {
    return false;
  }
  if (!ComputePass(FinalPass(options_), stopped)) {
    return false;
  }
  progress_->PrintSummary();
  return true;
}

bool StereoRun::Prepare(const std::function<bool()>& stopped) {
  CheckOptions(options_);
  std::cout << "Reading workspace " << location_.path << " ..." << std::endl;
  const colmap::mvs::Model model = ReadWorkspace(location_);
  views_ = SceneViews(model, options_.max_image_size);
  problems_ = ResolveProblems(ReadProblemConfig(location_.ConfigPath()), model,
                              options_.min_triangulation_angle);
  DropMissing();
  CheckDepthRanges();
  CheckRecords();
  CheckMaps();
  PrepareFolders();
  WarnOfMissingPictures();
  std::cout << "Configuration has " << NumViews() << " views." << std::endl;

  // A depth map takes four times the bytes of its photograph.
  const double cache_bytes = CacheBytes(options_.cache_size);
  photos_ = std::make_unique<ViewCache<uint8_t>>(
      cache_bytes / 5, [this](int view) { return ReadPhoto(views_[view]); });
  depth_maps_ =
      std::make_unique<ViewCache<float>>(cache_bytes * 4 / 5, [this](int view) {
        return ReadDepthMap(MapPath("depth_maps", view, Pass::kPhotometric),
                            views_[view].width, views_[view].height);
      });
  return ReadPhotos(stopped);
}

// Finds images and maps that are missing, and views that have no sources.
void StereoRun::DropMissing() {
  // A view that is dropped makes no map for others.
  while (DropMissingOnce()) {
  }
  if (problems_.empty()) {
    throw Failure("There is no view left that stereo can be computed for");
  }
}

// Returns whether it has dropped anything.
bool StereoRun::DropMissingOnce() {
  std::unordered_set<int> computed;
  for (const ViewIndices& problem : problems_) {
    computed.insert(problem.reference);
  }
  // Empty, or what a view lacks to be used.
  const auto lacks = [&](int view) -> std::string {
    if (!ExistsPath(views_[view].image_path)) {
      return "its image " + views_[view].image_path + " is missing";
    }
    const std::string map_path =
        MapPath("depth_maps", view, Pass::kPhotometric);
    if (FinalPass(options_) == Pass::kGeometric && computed.count(view) == 0 &&
        !ExistsPath(map_path)) {
      return "the map " + map_path +
             " is missing and the view is not in the list of views to compute";
    }
    return "";
  };
  const auto drop = [&](const std::string& text) {
    if (!options_.allow_missing_files) {
      throw Failure(text +
                    "; to leave it out, set "
                    "--PatchMatchStereo.allow_missing_files 1");
    }
    PrintWarning(text + "; it is left out");
  };

  bool dropped = false;
  std::vector<ViewIndices> kept_problems;
  for (const ViewIndices& problem : problems_) {
    const std::string& name = views_[problem.reference].name;
    ViewIndices kept;
    kept.reference = problem.reference;
    std::string error = lacks(problem.reference);
    if (error.empty()) {
      for (const int source : problem.sources) {
        const std::string source_error = lacks(source);
        if (source_error.empty()) {
          kept.sources.push_back(source);
        } else {
          drop("Source image " + views_[source].name + " of " + name +
               " cannot be used: " + source_error);
          dropped = true;
        }
      }
      if (kept.sources.empty()) {
        error =
            "it has no source images (none shares enough points with it, "
            "or none is named)";
      }
    }
    if (error.empty()) {
      kept_problems.push_back(kept);
    } else {
      drop("View " + name + " cannot be computed: " + error);
      dropped = true;
    }
  }
  problems_ = kept_problems;
  return dropped;
}

void StereoRun::CheckDepthRanges() const {
  for (const ViewIndices& problem : problems_) {
    const SceneView& view = views_[problem.reference];
    if (options_.depth_min < 0 && !(view.depth_min > 0)) {
      throw Failure("The sparse model has no points in view " + view.name +
                    " to take its range of depths from; set "
                    "--PatchMatchStereo.depth_min and depth_max");
    }
  }
}

// Looks at which options made the maps that are there already.
void StereoRun::CheckRecords() const {
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    if (pass > FinalPass(options_) || !HasMaps(pass)) {
      continue;
    }
    const bool geometric = pass == Pass::kGeometric;
    const std::string maps =
        std::string("The ") + (geometric ? "geometric" : "photometric") +
        " maps in " + location_.StereoPath() + " were made with ";
    const std::optional<OptionValues> recorded =
        ReadOptionsRecord(location_.RecordPath(geometric));
    if (!recorded) {
      PrintWarning(
          maps +
          "options that are not known (by another version of COLMAP?); "
          "they are kept");
      continue;
    }
    const std::string differences =
        DescribeDifferences(*recorded, RecordedOptions(pass));
    if (differences.empty()) {
      continue;
    }
    const auto was_on = [&recorded](const char* name) {
      const auto found = recorded->find(name);
      return found != recorded->end() && found->second == "1";
    };
    const bool was_final = pass != FinalPass(options_) &&
                           (was_on("filter") || was_on("tapa_refinement"));
    throw Failure(
        maps + "other options (PatchMatchStereo: " + differences +
        (was_final ? "; before a geometric pass nothing is filtered" : "") +
        "); take the same options, name another workspace, or remove all " +
        (geometric ? "*.geometric.bin"
         : pass == FinalPass(options_)
             ? "*.photometric.bin"
             : "*.photometric.bin and *.geometric.bin") +
        " there to have them computed again");
  }
}

// Looks at the maps that are there already.
void StereoRun::CheckMaps() const {
  for (const ViewIndices& problem : problems_) {
    IsDone(problem.reference, Pass::kPhotometric);
    IsDone(problem.reference, FinalPass(options_));
    if (FinalPass(options_) == Pass::kPhotometric) {
      continue;
    }
    for (const int source : problem.sources) {
      const std::string path =
          MapPath("depth_maps", source, Pass::kPhotometric);
      const std::string error = ExistsPath(path)
                                    ? CheckMapFile(path, views_[source].width,
                                                   views_[source].height, 1)
                                    : "";
      if (!error.empty()) {
        throw Damaged(path, error);
      }
    }
  }
}

// Reads all photographs that are needed, so that a damaged one is found before
// hours are spent. The cache keeps what fits.
bool StereoRun::ReadPhotos(const std::function<bool()>& stopped) {
  std::set<int> needed;
  for (const ViewIndices& problem : problems_) {
    if (!IsDone(problem.reference, Pass::kPhotometric) ||
        !IsDone(problem.reference, FinalPass(options_))) {
      needed.insert(problem.reference);
      needed.insert(problem.sources.begin(), problem.sources.end());
    }
  }
  for (const int view : needed) {
    if (stopped()) {
      return false;
    }
    photos_->Get(view);
  }
  return true;
}

void StereoRun::PrepareFolders() const {
  std::set<std::string> folders;
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    for (const ViewIndices& problem : problems_) {
      if (pass > FinalPass(options_) || IsDone(problem.reference, pass)) {
        continue;
      }
      for (const char* kind :
           {"depth_maps", "normal_maps", "consistency_graphs"}) {
        if (std::string(kind) != "consistency_graphs" || WritesGraph(pass)) {
          folders.insert(
              colmap::GetParentDir(MapPath(kind, problem.reference, pass)));
        }
      }
    }
  }
  for (const std::string& folder : folders) {
    PrepareFolder(folder, "maps");
  }
  for (const ViewIndices& problem : problems_) {
    if (WritesPictures(FinalPass(options_)) &&
        !IsDone(problem.reference, FinalPass(options_))) {
      PrepareFolder(TapaPictureFolder(options_.tapa_debug,
                                      views_[problem.reference].name),
                    "the pictures of tapa_debug");
    }
  }
}

// Pictures show a computation, not its maps.
void StereoRun::WarnOfMissingPictures() const {
  if (!WritesPictures(FinalPass(options_))) {
    return;
  }
  const auto num_done = std::count_if(
      problems_.begin(), problems_.end(), [this](const ViewIndices& problem) {
        return IsDone(problem.reference, FinalPass(options_));
      });
  if (num_done > 0) {
    PrintWarning(
        std::to_string(num_done) + " of " + std::to_string(NumViews()) +
        " views have their maps already, so that this run draws no "
        "pictures of them; to get some, remove their " +
        (FinalPass(options_) == Pass::kGeometric ? "*.geometric.bin"
                                                 : "*.photometric.bin"));
  }
}

OptionValues StereoRun::RecordedOptions(Pass pass) const {
  PatchMatchOptions options = PassOptions(options_, pass);
  // A limit that no photograph reaches is none.
  const bool is_limited =
      std::any_of(views_.begin(), views_.end(), [](const SceneView& view) {
        return view.width != view.photo_width ||
               view.height != view.photo_height;
      });
  if (!is_limited) {
    options.max_image_size = -1;
  }
  return OptionsOfMaps(options);
}

std::string StereoRun::MapPath(const std::string& kind, int view,
                               Pass pass) const {
  return location_.MapPath(kind, views_[view].name, pass == Pass::kGeometric);
}

bool StereoRun::WritesGraph(Pass pass) const {
  // The pass before the final one does not filter.
  return options_.write_consistency_graph && pass == FinalPass(options_);
}

bool StereoRun::WritesPictures(Pass pass) const {
  return options_.tapa.enabled && !options_.tapa_debug.empty() &&
         pass == FinalPass(options_);
}

bool StereoRun::HasMaps(Pass pass) const {
  // Views that this run does not compute count as well: the record is about
  // all maps beside it.
  for (int view = 0; view < static_cast<int>(views_.size()); ++view) {
    for (const char* kind : {"depth_maps", "normal_maps"}) {
      if (ExistsPath(MapPath(kind, view, pass))) {
        return true;
      }
    }
  }
  return false;
}

bool StereoRun::IsDone(int view, Pass pass) const {
  const int width = views_[view].width;
  const int height = views_[view].height;
  const auto is_there = [&](const char* kind, int channels) {
    const std::string path = MapPath(kind, view, pass);
    if (!ExistsPath(path)) {
      return false;
    }
    const std::string error = channels == 0
                                  ? CheckGraphFile(path, width, height)
                                  : CheckMapFile(path, width, height, channels);
    if (!error.empty()) {
      throw Damaged(path, error);
    }
    return true;
  };
  const bool has_depth = is_there("depth_maps", 1);
  const bool has_normal = is_there("normal_maps", 3);
  const bool has_graph =
      !WritesGraph(pass) || is_there("consistency_graphs", 0);
  return has_depth && has_normal && has_graph;
}

bool StereoRun::ComputePass(Pass pass, const std::function<bool()>& stopped) {
  if (!HasMaps(pass)) {
    WriteOptionsRecord(location_.RecordPath(pass == Pass::kGeometric),
                       RecordedOptions(pass));
  }
  std::atomic<size_t> next(0);
  std::atomic<bool> halted(false);
  std::exception_ptr error;
  const auto work = [&](int device) {
    const auto halt = [&] { return halted || stopped(); };
    while (!halted && !LeavesViewsToOthers(device)) {
      const size_t i = next++;
      if (i >= problems_.size()) {
        break;
      }
      try {
        if (halt() || !ComputeNumberedView(i, pass, device, halt)) {
          halted = true;
        }
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        error = error ? error : std::current_exception();
        halted = true;
      }
    }
  };
  // The calling thread is the first worker.
  std::vector<std::thread> others;
  for (size_t i = 1; i < workers_.size(); ++i) {
    try {
      others.emplace_back(work, workers_[i]);
    } catch (const std::system_error&) {
      break;  // Those that could be started share out its views.
    }
  }
  work(workers_[0]);
  for (std::thread& other : others) {
    other.join();
  }
  // What was left to others that did not come to it.
  work(kCpu);
  if (halted) {
    progress_->ClearLine();
  }
  if (error) {
    std::rethrow_exception(error);
  }
  return !halted;
}

// Returns false if stopped.
bool StereoRun::ComputeNumberedView(size_t number, Pass pass, int device,
                                    const std::function<bool()>& stopped) {
  const ViewIndices& problem = problems_[number];
  if (!IsDone(problem.reference, pass)) {
    const bool geometric = pass == Pass::kGeometric;
    const SceneView& view = views_[problem.reference];
    const int progress_view = progress_->BeginView(
        (geometric ? "geometric " : "photometric ") +
            std::to_string(number + 1) + "/" + std::to_string(NumViews()),
        view.name, geometric, Megapixels(view));
    if (!ComputeView(problem, pass, device, progress_view, stopped)) {
      return false;
    }
    progress_->EndView(progress_view);
  }
  num_done_ += pass == FinalPass(options_);
  return true;
}

// The engine's problem for a view, and what it borrows.
struct StereoRun::Input {
  Problem problem;
  std::optional<Map<Rgb>> color;
  std::vector<std::shared_ptr<const Map<uint8_t>>> photos;
  std::vector<std::shared_ptr<const Map<float>>> depth_maps;
};

// Returns false if stopped.
bool StereoRun::ReadInput(const ViewIndices& problem, bool geometric,
                          bool color, const std::function<bool()>& stopped,
                          Input* input) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const SceneView& reference = views_[problem.reference];
  const auto to_view = [&](int index) {
    View view;
    view.camera = views_[index].camera;
    input->photos.push_back(photos_->Get(index));
    view.image = input->photos.back().get();
    return view;
  };

  Problem& to = input->problem;
  to.reference = to_view(problem.reference);
  for (const int source : problem.sources) {
    if (stopped()) {
      return false;
    }
    to.sources.push_back(to_view(source));
    if (geometric) {
      input->depth_maps.push_back(depth_maps_->Get(source));
      to.sources.back().depth = input->depth_maps.back().get();
    }
  }
  if (geometric) {
    to.depth = *depth_maps_->Get(problem.reference);
    to.normal = ReadNormalMap(
        MapPath("normal_maps", problem.reference, Pass::kPhotometric),
        reference.width, reference.height);
  }
  if (color) {
    input->color = ReadColorPhoto(reference);
    to.reference_color = &*input->color;
  }
  const bool has_range = options_.depth_min >= 0;
  to.depth_min = has_range ? options_.depth_min : reference.depth_min;
  to.depth_max = has_range ? options_.depth_max : reference.depth_max;
  return true;
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
    progress_->ClearLine();
    PrintWarning(why + ": from now on the CPU is used in its place");
  }
}

// Returns false if stopped.
bool StereoRun::ComputeView(const ViewIndices& problem, Pass pass, int device,
                            int progress_view,
                            const std::function<bool()>& stopped) {
  if (device == kCpu) {
    return ComputeViewOn(kCpu, problem, pass, progress_view, stopped);
  }
  const std::string& name = views_[problem.reference].name;
  if (!IsLost(device)) {
    try {
      return ComputeViewOn(device, problem, pass, progress_view, stopped);
    } catch (const DeviceLimitError& error) {
      progress_->ClearLine();
      PrintWarning("View " + name + " cannot be computed on GPU " +
                   std::to_string(device) + " (" + error.what() +
                   "): the CPU is used for it");
    } catch (const DeviceError& error) {
      GiveUp(device, "GPU " + std::to_string(device) + " failed at view " +
                         name + " (" + error.what() + ")");
    }
    progress_->Update(progress_view, 0);
  }
  const std::lock_guard<std::mutex> turn(cpu_mutex_);
  return ComputeViewOn(kCpu, problem, pass, progress_view, stopped);
}

// Returns false if stopped.
bool StereoRun::ComputeViewOn(int device, const ViewIndices& problem, Pass pass,
                              int progress_view,
                              const std::function<bool()>& stopped) {
  const bool geometric = pass == Pass::kGeometric;
  const SceneView& reference = views_[problem.reference];
  Options options = EngineOptions(PassOptions(options_, pass));
  options.seed = ViewSeed(options_.seed, reference.name, geometric);
  options.device = device;

  Input input;
  if (!ReadInput(problem, geometric, options.tapa.enabled, stopped, &input)) {
    return false;
  }
  Control control;
  control.progress = [&](double share) {
    progress_->Update(progress_view, share);
  };
  control.stopped = stopped;
  TapaRecord record;
  if (WritesPictures(pass)) {
    control.record = &record;
  }

  const size_t memory = EstimateDepthMemory(options, input.problem);
  std::optional<Estimate> estimate;
  try {
    estimate = EstimateDepth(options, std::move(input.problem), control);
  } catch (const std::invalid_argument& error) {
    throw Failure("View " + reference.name +
                  " cannot be computed: " + error.what());
  } catch (const std::bad_alloc&) {
    throw Failure("View " + reference.name + " needs about " +
                  std::to_string(memory >> 20) +
                  " MB of memory; lower --PatchMatchStereo.max_image_size or "
                  "cache_size");
  }
  return estimate &&
         WriteView(problem, pass, *estimate, input, record,
                   static_cast<float>(options.tapa.min_textureness), stopped);
}

// Returns false if stopped.
bool StereoRun::WriteView(const ViewIndices& problem, Pass pass,
                          const Estimate& estimate, const Input& input,
                          const TapaRecord& record, float min_textureness,
                          const std::function<bool()>& stopped) {
  const SceneView& reference = views_[problem.reference];
  // Before the maps, so that a run that is cut off here draws them again.
  if (WritesPictures(pass)) {
    TapaView view;
    view.title = reference.name;
    view.photograph = &*input.color;
    view.record = &record;
    view.depth = &estimate.depth;
    view.normal = &estimate.normal;
    view.min_textureness = min_textureness;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!WriteTapaPictures(
            view, TapaPictureFolder(options_.tapa_debug, reference.name),
            stopped)) {
      return false;
    }
  }
  WriteDepthMap(MapPath("depth_maps", problem.reference, pass), estimate.depth);
  WriteNormalMap(MapPath("normal_maps", problem.reference, pass),
                 estimate.normal);
  if (WritesGraph(pass)) {
    WriteGraph(MapPath("consistency_graphs", problem.reference, pass),
               reference.width, reference.height,
               ConsistencyGraph(estimate, problem.sources));
  }
  return true;
}

}  // namespace tapa
