#include "src/colmap/part_files.h"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/ply_files.h"
#include "util/misc.h"

namespace tapa {
namespace {

std::string PartPath(const std::string& path) { return path + ".part"; }

// why: what is known of it.
void PrintNotMade(const std::string& path, const std::string& why) {
  PrintError(path + " could not be made" + why +
             "; is there room, and can its folder and the current one, where "
             "the mesher writes as well, be written");
}

// While one of these lives, the program cannot end as if nothing was wrong.
class ExitGuard {
 public:
  explicit ExitGuard(const std::string& path) {
    static const bool is_registered = std::atexit(&EndWithError) == 0;
    static_cast<void>(is_registered);
    path_ = path;
  }
  ~ExitGuard() { path_.clear(); }
  ExitGuard(const ExitGuard&) = delete;
  ExitGuard& operator=(const ExitGuard&) = delete;

 private:
  static void EndWithError() {
    if (!path_.empty()) {
      PrintNotMade(path_, "");
      _exit(EXIT_FAILURE);
    }
  }

  static std::string path_;
};

std::string ExitGuard::path_;

}  // namespace

std::string MakePart(const std::string& path) {
  std::error_code error;
  std::filesystem::remove_all(PartPath(path), error);
  std::filesystem::create_directories(PartPath(path), error);
  if (error) {
    throw Failure("The folder " + PartPath(path) +
                  " cannot be made: " + error.message());
  }
  return PartPath(path);
}

void CommitPart(const std::string& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  std::filesystem::rename(PartPath(path), path, error);
  if (error) {
    throw Failure(PartPath(path) + " cannot be renamed to " + path + ": " +
                  error.message());
  }
}

void CheckWritten(const std::string& path, std::ofstream* file) {
  file->close();
  if (!*file) {
    throw Failure("Cannot write " + path +
                  "; see to it that there is room and that the folder can be "
                  "written, then run the same command again to go on");
  }
}

bool WriteWhole(const std::string& path,
                const std::function<bool(const std::string&)>& write) {
  // Meshing adds the extension where it is missing.
  const std::filesystem::path final_path = path;
  std::filesystem::path part_path = path;
  part_path.replace_extension(PartPath("") + final_path.extension().string());
  std::error_code error;
  std::filesystem::remove(part_path, error);
  const ExitGuard guard(path);
  const FatalErrors fatal_errors(path + " could not be made");
  std::string why;
  try {
    if (write(part_path.string()) && IsWholePly(part_path.string())) {
      std::filesystem::rename(part_path, final_path, error);
      if (!error) {
        return true;
      }
      why = ": " + error.message();
    }
  } catch (const std::exception& exception) {
    why = std::string(": ") + exception.what();
  }
  std::filesystem::remove(part_path, error);
  PrintNotMade(path, why);
  return false;
}

bool IsWholeWorkspace(const std::string& path) {
  // After photographs and model the undistorter writes these.
  const auto has = [&path](const char* name) {
    return colmap::ExistsFile(colmap::JoinPaths(path, "stereo", name));
  };
  return has("patch-match.cfg") && has("fusion.cfg");
}

}  // namespace tapa
