#ifndef TAPA_PYTHON_JOBS_H_
#define TAPA_PYTHON_JOBS_H_

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// Dense stereo and fusion as a library for programs that are not ours. This
// header and the library behind it, libtapa_jobs.so, show nothing of COLMAP
// (jobs.map lists what they do).

namespace tapa {

using JobValue = std::variant<bool, int, double, std::string>;
// By the names of the command line, without what stands before the point.
using JobOptions = std::map<std::string, JobValue>;

// All options that there are, with their defaults.
JobOptions StereoDefaults();
JobOptions FusionDefaults();

// What the options of the commands that are no JobOptions say.
struct StereoTask {
  std::string workspace_path;
  std::string workspace_format;  // "colmap" or "pmvs"
  std::string pmvs_option_name;
  std::string config_path;
  // Those to change; of the same names and types as StereoDefaults().
  JobOptions options;
};

struct FusionTask {
  std::string workspace_path;
  std::string workspace_format;  // "colmap" or "pmvs"
  std::string pmvs_option_name;
  std::string input_type;  // "photometric" or "geometric"
  std::string bbox_path;   // Empty: none.
  std::string output_path;
  // Those to change; of the same names and types as FusionDefaults().
  JobOptions options;
};

class JobState;

// A run of dense stereo or fusion, in threads of its own. Meanwhile what the
// process prints by std::cout and std::cerr goes to the job. A check of
// COLMAP's that fails ends the job, but not the process; what it held is lost.
class Job {
 public:
  // Start. Throw std::runtime_error if another job is running.
  explicit Job(const StereoTask& task);
  explicit Job(const FusionTask& task);
  // Stops it.
  ~Job();

  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  // Waits for its end, at most so many seconds. Returns whether it has ended.
  bool Wait(double seconds);
  // Asks it to end, which takes some milliseconds, and waits for that. Another
  // run goes on where this one was.
  void Stop();

  // How far it is: share of the work, 0 to 1, and words for the user. Nothing
  // is known of fusion.
  std::pair<double, std::string> Progress() const;
  // The lines that were printed since the last call.
  std::vector<std::string> TakeLines();

  // Once it has ended: whether all of it was done, and what was wrong if not.
  bool IsDone() const;
  std::vector<std::string> Errors() const;

 private:
  std::shared_ptr<JobState> state_;
};

}  // namespace tapa

#endif  // TAPA_PYTHON_JOBS_H_
