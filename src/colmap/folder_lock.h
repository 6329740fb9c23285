#ifndef TAPA_SRC_COLMAP_FOLDER_LOCK_H_
#define TAPA_SRC_COLMAP_FOLDER_LOCK_H_

#include <string>

namespace tapa {

// While one of these lives no other process, nor this one again, gets one of
// the same folder: runs of stereo in one workspace would take away each other's
// maps of coarse levels. The system unlocks when the process ends, however it
// does, and leaves no file behind. A file system that knows no locks of folders
// has none.
class FolderLock {
 public:
  enum class With {
    kNobody,
    // Others that say so, too, such as on other machines.
    kWorkers,
  };

  // Throws Failure if another has it.
  FolderLock(const std::string& folder, With with);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  const int file_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_FOLDER_LOCK_H_
