#include "src/colmap/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "src/base/failure.h"

namespace tapa {

FolderLock::FolderLock(const std::string& folder, With with)
    : file_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // What is wrong with the folder itself is for others to say.
  const int kind = with == With::kWorkers ? LOCK_SH : LOCK_EX;
  if (file_ >= 0 && flock(file_, kind | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file_);
    throw Failure("Another run of stereo computes in " + folder +
                  "; wait until it has ended, or stop it");
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) {
    close(file_);
  }
}

}  // namespace tapa
