#include "src/colmap/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"

namespace tapa {

FolderLock::FolderLock(const std::string& folder, Use use)
    : file_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // What is wrong with the folder itself is for others to say.
  if (file_ >= 0 &&
      flock(file_, (use == Use::kShared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 &&
      errno == EWOULDBLOCK) {
    close(file_);
    throw Failure("Another run is at work in " + folder +
                  "; wait until it has ended, or stop it");
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) {
    close(file_);
  }
}

std::shared_ptr<const FolderLock> LockFolder(const std::string& folder) {
  try {
    return std::make_shared<const FolderLock>(folder);
  } catch (const Failure& error) {
    PrintError(error.what());
    return nullptr;
  }
}

}  // namespace tapa
