#include "src/base/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <mutex>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

// What a temporary name has behind the final one, before the name of the
// machine.
constexpr char kMark[] = ".part-";

std::string HostName() {
  char host[HOST_NAME_MAX + 1] = "";
  gethostname(host, sizeof(host) - 1);
  return host;
}

// A long name is cut, so that there is room for the mark.
std::string CutName(const std::string& name, size_t room) {
  return name.substr(0, NAME_MAX - std::min<size_t>(room, NAME_MAX));
}

// Beside the file, and unlike any other.
std::string TemporaryPath(const std::string& path) {
  static std::atomic<int> counter(0);
  const std::string end = kMark + HostName() + "-" + std::to_string(getpid()) +
                          "-" + std::to_string(counter++);
  const size_t name = path.rfind('/') + 1;
  return path.substr(0, name) + CutName(path.substr(name), end.size()) + end;
}

// Makes the file and locks it, so that others see that it is being written. One
// of them may be about to remove it, whom this waits for, or have removed it
// before it was locked.
int OpenLocked(const std::string& path) {
  while (true) {
    const int file =
        open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    struct stat status = {};
    if (file < 0 || flock(file, LOCK_EX) != 0 || fstat(file, &status) != 0 ||
        status.st_nlink > 0) {
      return file;
    }
    close(file);
  }
}

// Whether a name is one of TemporaryPath: it ends with the mark, a machine, and
// two numbers. mark: where the last mark begins.
bool IsTemporary(const std::string& name, size_t mark) {
  size_t end = name.size();
  for (int i = 0; i < 2; ++i) {
    const size_t dash = name.find_last_not_of("0123456789", end - 1);
    if (dash == std::string::npos || name[dash] != '-' || dash + 1 == end ||
        dash < mark + sizeof(kMark)) {
      return false;
    }
    end = dash;
  }
  return true;
}

// Removes a file with a temporary name if it is nobody's any more: the system
// unlocks it when its process ends. Some shared file systems know locks of one
// machine only, or none, so that what may be of another process there has to be
// old as well.
void RemoveIfStale(const std::string& path, bool is_of_this_host) {
  constexpr time_t kOld = 24 * 3600;
  // A stranger's workspace may have anything under such a name.
  const int file =
      open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) {
    return;
  }
  const bool is_locked = flock(file, LOCK_EX | LOCK_NB) != 0;
  const bool knows_locks = !is_locked || errno == EWOULDBLOCK;
  struct stat status = {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
    const bool is_old = std::time(nullptr) - status.st_mtime > kOld;
    if (knows_locks ? !is_locked && (is_of_this_host || is_old) : is_old) {
      unlink(path.c_str());
    }
  }
  close(file);
}

// The names of a folder's unfinished files.
std::vector<std::string> ListTemporaries(const std::string& folder) {
  std::vector<std::string> names;
  DIR* dir = opendir(folder.c_str());
  if (dir == nullptr) {
    return names;
  }
  while (const dirent* entry = readdir(dir)) {
    const std::string name = entry->d_name;
    const size_t mark = name.rfind(kMark);
    if (mark != std::string::npos && IsTemporary(name, mark)) {
      names.push_back(name);
    }
  }
  closedir(dir);
  return names;
}

// The same as they were when this process first asked: listing a folder for
// each of its files takes a time that grows with the square of their number.
// What is left there later the next process finds.
std::vector<std::string> FirstTemporaries(const std::string& folder) {
  static std::mutex mutex;
  static std::map<std::string, std::vector<std::string>> found;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto [entry, is_new] = found.try_emplace(folder);
  if (is_new) {
    entry->second = ListTemporaries(folder);
  }
  return entry->second;
}

// Removes those of these unfinished files that nobody writes any more, of all
// names that begin with this.
void RemoveStale(const std::string& folder,
                 const std::vector<std::string>& names,
                 const std::string& begin) {
  const std::string own_mark = kMark + HostName() + "-";
  for (const std::string& name : names) {
    if (name.compare(0, begin.size(), begin) == 0) {
      RemoveIfStale(
          folder + "/" + name,
          name.compare(name.rfind(kMark), own_mark.size(), own_mark) == 0);
    }
  }
}

// Of the file itself, from runs that were cut off.
void RemoveStaleOf(const std::string& path) {
  const size_t name = path.rfind('/') + 1;
  const std::string folder = name == 0 ? "." : path.substr(0, name);
  constexpr size_t kRoom = 128;  // Enough for any mark.
  RemoveStale(folder, FirstTemporaries(folder),
              CutName(path.substr(name) + kMark, kRoom));
}

// Some mounts have no fsync; of them some tell when a file is closed what could
// not be written. So a copy is closed: closing the file itself would unlock it.
bool Synchronize(int file) {
  if (fsync(file) != 0 && errno != EINVAL && errno != ENOSYS &&
      errno != ENOTSUP) {
    return false;
  }
  const int copy = dup(file);
  return copy >= 0 && close(copy) == 0;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path), temporary_path_(TemporaryPath(path)) {
  RemoveStaleOf(path);
  file_ = OpenLocked(temporary_path_);
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

void AtomicFile::Finish() {
  if (!is_finished_ && !Synchronize(file_)) {
    Fail();
  }
  is_finished_ = true;
}

void AtomicFile::Commit() {
  Finish();
  if (rename(temporary_path_.c_str(), path_.c_str()) != 0) {
    Fail();
  }
  close(file_);
  file_ = -1;
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
  RemoveStale(folder, ListTemporaries(folder), "");
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
