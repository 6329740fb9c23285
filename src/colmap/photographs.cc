#include "src/colmap/photographs.h"

#include <FreeImage.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <system_error>

#include "src/base/atomic_file.h"
#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/progress.h"
#include "src/colmap/text_files.h"
#include "src/colmap/views_record.h"
#include "util/misc.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

// By name: what tells the photograph from others, see DescribeFile.
using Contents = std::map<std::string, std::string>;

Contents ReadContents(const std::string& path) {
  Contents contents;
  if (!colmap::ExistsFile(path)) {
    return contents;
  }
  TextLines lines(path);
  std::string line;
  while (lines.Next(&line)) {
    const size_t blank = line.find(' ');
    if (blank != std::string::npos) {
      contents[line.substr(blank + 1)] = line.substr(0, blank);
    }
  }
  return contents;
}

void WriteContents(const std::string& path, const Contents& contents) {
  std::string text;
  for (const auto& [name, content] : contents) {
    text += content + " " + name + "\n";
  }
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

// Throws Failure; in the graphical interface, prints it.
void Fail(const std::string& text) {
  if (!IsGraphical()) {
    throw Failure(text);
  }
  PrintError(text);
}

// What cannot be read may be a photograph.
void CheckReadable(const fs::path& path) {
  std::error_code ignored;
  std::ifstream file(path, std::ios::binary);
  if (fs::is_regular_file(path, ignored) &&
      (!file || (file.get(), file.bad()))) {
    Fail("The file " + path.string() +
         " cannot be read: " + std::strerror(errno));
  }
}

}  // namespace

std::vector<std::string> FindPhotographs(const std::string& image_path,
                                         const std::string& workspace_path) {
  std::vector<std::string> names;
  std::error_code error;
  fs::recursive_directory_iterator entry(
      image_path, fs::directory_options::follow_directory_symlink, error);
  for (; !error && entry != fs::end(entry); entry.increment(error)) {
    const fs::path path = entry->path();
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (fs::equivalent(path, workspace_path, ignored)) {
        entry.disable_recursion_pending();
      }
    } else if (FreeImage_GetFileType(path.c_str()) != FIF_UNKNOWN) {
      names.push_back(path.lexically_relative(image_path).string());
    } else {
      CheckReadable(path);
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    Fail("The folder " + image_path + " cannot be read: " + error.message());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool KeepPhotographs(const std::string& image_path,
                     const std::string& workspace_path) {
  try {
    const std::vector<std::string> names =
        FindPhotographs(image_path, workspace_path);
    if (names.empty()) {
      PrintError("There are no photographs that can be read in " + image_path);
      return false;
    }
    const std::string path =
        colmap::JoinPaths(workspace_path, "photographs.txt");
    Contents contents = ReadContents(path);
    std::vector<std::string> others;
    for (const std::string& name : names) {
      const std::string content =
          DescribeFile(colmap::JoinPaths(image_path, name));
      if (contents.emplace(name, content).first->second != content) {
        others.push_back(name);
      }
    }
    if (!others.empty()) {
      PrintWarning(
          std::to_string(others.size()) + " photographs in " + image_path +
          ", such as " + others[0] +
          ", are others than those that the reconstruction in " +
          workspace_path +
          " was made from; what is there of it is kept. To begin anew, "
          "name another --workspace_path");
    }
    WriteContents(path, contents);
  } catch (const Failure& error) {
    PrintError(error.what());
    return false;
  }
  return true;
}

}  // namespace tapa
