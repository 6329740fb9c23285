#ifndef TAPA_SRC_COLMAP_FOLDER_LOCK_H_
#define TAPA_SRC_COLMAP_FOLDER_LOCK_H_

#include <memory>
#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// While one of these lives no other process, nor this one again, gets one of
// the same folder: runs of stereo in one workspace would take away each other's
// maps of coarse levels. The system unlocks when the process ends, however it
// does, and leaves no file behind. A file system that knows no locks of folders
// has none.
class FolderLock {
 public:
  // Those who share a folder: fusions, which only read, and the workers of one
  // run on several machines, which each write their own maps. A run of stereo
  // has the folder alone.
  enum class Use { kAlone, kShared };

  // Throws Failure if another has it.
  explicit FolderLock(const std::string& folder, Use use = Use::kAlone);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  const int file_;
};

// The same for changes, to be held by COLMAP's own code. Prints an error and
// returns nullptr in place of a Failure.
std::shared_ptr<const FolderLock> LockFolder(const std::string& folder);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FOLDER_LOCK_H_
