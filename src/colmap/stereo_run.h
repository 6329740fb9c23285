#ifndef TAPA_SRC_COLMAP_STEREO_RUN_H_
#define TAPA_SRC_COLMAP_STEREO_RUN_H_

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "src/colmap/problem_reader.h"
#include "src/colmap/progress.h"
#include "src/colmap/stereo_plan.h"
#include "src/mvs/problem.h"

namespace tapa {

struct NamedPicture;

// Does a program's part of what a plan lists, pass by pass, each worker one
// view after the other. A run that was stopped, or ended by an error, leaves
// complete maps, and another one that goes on from there ends with the same
// files.
class StereoRun {
 public:
  // workers: for each the GPU that it computes on, or kCpu. stopped: asked
  // often, and by several threads, whether to end the run. listener: hears how
  // far it is.
  StereoRun(StereoPlan plan, std::vector<int> workers,
            std::function<bool()> stopped, ProgressListener listener = nullptr);

  // Returns false if stopped. Throws Failure.
  bool Run();

  // Number of views whose final maps are there, and of all views.
  int NumDone() const { return num_done_; }
  int NumViews() const { return static_cast<int>(plan_.num_results); }

 private:
  // A view to compute in a pass.
  struct Task {
    const PassPlan& pass;
    const ViewIndices& problem;
    const SceneView& view;
    bool draws;
    // The number by which progress_ knows it.
    int progress_view;
  };

  bool Stopped() const { return halted_ || stopped_(); }
  void PrepareFolders() const;
  // Leaves nothing but the result, whichever programs have worked on it.
  void TidyUp() const;
  bool Computes(const PassPlan& pass) const;
  void WriteRecords(const PassPlan& pass) const;
  std::vector<int> WorkersOf(const PassPlan& pass) const;
  // The functions below return false if stopped.
  bool ComputePass(const PassPlan& pass);
  bool ComputeProblem(size_t number, const PassPlan& pass, int device);
  bool ComputeView(const Task& task, int device);
  bool ComputeViewOn(int device, const Task& task);
  bool JudgeView(const Task& task);
  bool WritePictures(const Task& task,
                     const std::function<std::vector<NamedPicture>()>& draw);
  void WriteView(const Task& task, const Estimate& estimate,
                 const std::vector<int32_t>& graph) const;

  bool IsLost(int device);
  // Whether a worker's GPU is lost while there are others.
  bool LeavesViewsToOthers(int device);
  // Uses the GPU no more, and says why if that is new.
  void GiveUp(int device, const std::string& why);

  const StereoPlan plan_;
  const std::vector<int> workers_;
  const std::function<bool()> stopped_;
  ProblemReader reader_;
  Progress progress_;
  // Held while lost GPUs are asked for or pictures are written.
  std::mutex mutex_;
  // Held while the CPU, with all of its threads, computes in place of a GPU.
  std::mutex cpu_mutex_;
  // GPUs that do not work any more.
  std::set<int> lost_devices_;
  // Whether an error or a request has ended the run.
  std::atomic<bool> halted_{false};
  std::atomic<int> num_done_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_STEREO_RUN_H_
