#ifndef TAPA_SRC_BASE_ATOMIC_FILE_H_
#define TAPA_SRC_BASE_ATOMIC_FILE_H_

#include <cstddef>
#include <string>

namespace tapa {

// Writes a file beside its final name and renames it when it is complete. Until
// then it is locked, so that what a process left that was killed is known, and
// removed by the next one that writes the same file. (A folder is looked into
// once by a process, when it first writes there.)
class AtomicFile {
 public:
  // Throws Failure if the file cannot be made.
  explicit AtomicFile(const std::string& path);
  // Removes what was written, unless Commit was called.
  ~AtomicFile();

  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Appends bytes. Throws Failure if they cannot be written.
  void Write(const void* data, size_t size);

  // Sees to it that the content is on the disk, so that of several files none
  // gets its name before all are complete. Throws Failure.
  void Finish();

  // Finishes the file and gives it its final name. Throws Failure.
  void Commit();

 private:
  [[noreturn]] void Fail();

  const std::string path_;
  const std::string temporary_path_;
  int file_ = -1;
  bool is_finished_ = false;
};

// Removes from a folder the unfinished files that nobody writes any more.
void RemoveStaleTemporaries(const std::string& folder);

// Makes a folder if it is not there, removes such files from it, and throws
// Failure if files cannot be made in it. contents: what is written there, for
// the message.
void PrepareFolder(const std::string& path, const std::string& contents);

}  // namespace tapa

#endif  // TAPA_SRC_BASE_ATOMIC_FILE_H_
