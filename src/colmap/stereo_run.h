#ifndef TAPA_SRC_COLMAP_STEREO_RUN_H_
#define TAPA_SRC_COLMAP_STEREO_RUN_H_

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "mvs/patch_match.h"
#include "src/colmap/engine_options.h"
#include "src/colmap/options_record.h"
#include "src/colmap/problem_config.h"
#include "src/colmap/progress.h"
#include "src/colmap/view_cache.h"
#include "src/colmap/views.h"
#include "src/colmap/workspace.h"
#include "src/mvs/problem.h"

namespace tapa {

struct TapaRecord;

// Computes the maps of all views that a workspace's configuration lists, each
// worker one view after the other. What can be wrong is looked for before
// anything is computed. Maps that are there already are kept, so that a run
// that was stopped goes on where it was, and ends with the same files.
class StereoRun {
 public:
  // workers: for each the GPU that it computes on, or kCpu.
  StereoRun(const colmap::mvs::PatchMatchOptions& options,
            const WorkspaceLocation& location, std::vector<int> workers);

  // Returns false if stopped() ended the run, which it can at any time; maps
  // that are finished by then stay. Throws Failure.
  bool Run(const std::function<bool()>& stopped);

  // Number of views whose final maps are there, and of all views.
  int NumDone() const { return num_done_; }
  int NumViews() const { return static_cast<int>(problems_.size()); }

 private:
  // Returns false if stopped.
  bool Prepare(const std::function<bool()>& stopped);
  void DropMissing();
  bool DropMissingOnce();
  void CheckDepthRanges() const;
  void CheckRecords() const;
  void CheckMaps() const;
  bool ReadPhotos(const std::function<bool()>& stopped);
  void PrepareFolders() const;

  // The options that a pass's maps depend on.
  OptionValues RecordedOptions(Pass pass) const;
  std::string MapPath(const std::string& kind, int view, Pass pass) const;
  bool WritesGraph(Pass pass) const;
  bool WritesPictures(Pass pass) const;
  void WarnOfMissingPictures() const;
  // Whether there is any map of a pass.
  bool HasMaps(Pass pass) const;
  // Whether all maps of a view are there. Throws Failure if one is damaged.
  bool IsDone(int view, Pass pass) const;

  bool ComputePass(Pass pass, const std::function<bool()>& stopped);
  bool ComputeNumberedView(size_t number, Pass pass, int device,
                           const std::function<bool()>& stopped);
  bool ComputeView(const ViewIndices& problem, Pass pass, int device,
                   int progress_view, const std::function<bool()>& stopped);
  bool ComputeViewOn(int device, const ViewIndices& problem, Pass pass,
                     int progress_view, const std::function<bool()>& stopped);
  bool IsLost(int device);
  // Whether a worker's GPU is lost while there are others.
  bool LeavesViewsToOthers(int device);
  // Uses the GPU no more, and says why if that is new.
  void GiveUp(int device, const std::string& why);
  struct Input;
  bool ReadInput(const ViewIndices& problem, bool geometric, bool color,
                 const std::function<bool()>& stopped, Input* input);
  bool WriteView(const ViewIndices& problem, Pass pass,
                 const Estimate& estimate, const Input& input,
                 const TapaRecord& record, float min_textureness,
                 const std::function<bool()>& stopped);

  const colmap::mvs::PatchMatchOptions options_;
  const WorkspaceLocation location_;
  const std::vector<int> workers_;
  // Held while files are read or pictures written, and while workers share out
  // views.
  std::mutex mutex_;
  // Held while the CPU, with all of its threads, computes in place of a GPU.
  std::mutex cpu_mutex_;
  // GPUs that do not work any more.
  std::set<int> lost_devices_;
  std::vector<SceneView> views_;
  std::vector<ViewIndices> problems_;
  std::unique_ptr<ViewCache<uint8_t>> photos_;
  // Of the photometric pass.
  std::unique_ptr<ViewCache<float>> depth_maps_;
  std::unique_ptr<Progress> progress_;
  std::atomic<int> num_done_{0};
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_STEREO_RUN_H_
