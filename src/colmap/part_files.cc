#include "src/colmap/part_files.h"

#include <filesystem>
#include <system_error>

#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "util/misc.h"

namespace tapa {
namespace {

std::string PartPath(const std::string& path) { return path + ".part"; }

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

bool WriteWhole(const std::string& path,
                const std::function<bool(const std::string&)>& write) {
  // Meshing adds the extension where it is missing.
  const std::filesystem::path final_path = path;
  std::filesystem::path part_path = path;
  part_path.replace_extension(PartPath("") + final_path.extension().string());
  std::error_code error;
  std::filesystem::remove(part_path, error);
  if (write(part_path.string())) {
    std::filesystem::rename(part_path, final_path, error);
    if (!error) {
      return true;
    }
  }
  PrintError(path + " could not be made");
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
