#include "src/base/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>

#include "src/base/failure.h"

namespace tapa {
namespace {

constexpr char kPart[] = ".part-";

// What a temporary name has between the final one and the number of the
// process.
std::string TemporaryMark() {
  char host[HOST_NAME_MAX + 1] = "";
  gethostname(host, sizeof(host) - 1);
  return std::string(kPart) + host + "-";
}

// Whether nobody has written to a file for so long that nobody will.
bool IsForgotten(const std::string& path) {
  constexpr time_t kDay = 24 * 3600;
  struct stat file;
  return stat(path.c_str(), &file) == 0 && time(nullptr) - file.st_mtime > kDay;
}

// Beside the file, and unlike any other. A long name is cut, so that there is
// room for the mark.
std::string TemporaryPath(const std::string& path) {
  static std::atomic<int> counter(0);
  const std::string end = TemporaryMark() + std::to_string(getpid()) + "-" +
                          std::to_string(counter++);
  const size_t name = path.rfind('/') + 1;
  return path.substr(0, name) +
         path.substr(name, NAME_MAX - std::min<size_t>(end.size(), NAME_MAX)) +
         end;
}

// Some mounts have no fsync: what they keep is theirs to see to.
bool Synchronize(int file) {
  return fsync(file) == 0 || errno == EINVAL || errno == ENOSYS ||
         errno == ENOTSUP;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), temporary_path_(TemporaryPath(path)) {
  file_ = open(temporary_path_.c_str(),
               O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) {
    Fail();
  }
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) {
    close(file_);
    unlink(temporary_path_.c_str());
  }
}

void AtomicFile::Write(const void* data, size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(file_, bytes, size);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      Fail();
    }
    bytes += written;
    size -= written;
  }
}

void AtomicFile::Commit() {
  if (!Synchronize(file_)) {
    Fail();
  }
  const int file = file_;
  file_ = -1;
  if (close(file) != 0 || rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    const int error = errno;
    unlink(temporary_path_.c_str());
    errno = error;
    Fail();
  }
}

void AtomicFile::Fail() {
  const int error = errno;
  if (file_ >= 0) {
    close(file_);
    unlink(temporary_path_.c_str());
    file_ = -1;
  }
  throw Failure("Cannot write " + path_ + ": " + std::strerror(error) +
                "; see to it that there is room and that the folder can be "
                "written, then run the same command again to go on");
}

void RemoveStaleTemporaries(const std::string& folder) {
  DIR* dir = opendir(folder.c_str());
  if (dir == nullptr) {
    return;
  }
  const std::string mark = TemporaryMark();
  while (const dirent* entry = readdir(dir)) {
    const std::string name = entry->d_name;
    const std::string path = folder + "/" + name;
    const size_t position = name.rfind(mark);
    if (position == std::string::npos) {
      if (name.find(kPart) != std::string::npos && IsForgotten(path)) {
        unlink(path.c_str());
      }
      continue;
    }
    const long process = std::atol(name.c_str() + position + mark.size());
    if (process > 0 && kill(process, 0) != 0 && errno == ESRCH) {
      unlink(path.c_str());
    }
  }
  closedir(dir);
}

void PrepareFolder(const std::string& path, const std::string& contents) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) {
    throw Failure("There is no folder " + path + ", and it cannot be made" +
                  (error ? " (" + error.message() + ")" : "") + "; " +
                  contents + " are written there");
  }
  RemoveStaleTemporaries(path);
  AtomicFile probe(path + "/probe");
}

}  // namespace tapa
