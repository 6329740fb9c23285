#ifndef TAPA_SRC_BASE_ATOMIC_FILE_H_
#define TAPA_SRC_BASE_ATOMIC_FILE_H_

#include <cstddef>
#include <string>

namespace tapa {

// Writes a file beside its final name and renames it when it is complete. The
// temporary name says which process of which machine writes it.
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

  // Gives the file its final name once its content is on the disk. Throws
  // Failure if that cannot be done.
  void Commit();

 private:
  [[noreturn]] void Fail();

  const std::string path_;
  const std::string temporary_path_;
  int file_ = -1;
};

// Removes from a folder the unfinished files of processes of this machine that
// do not live any more, and those of other machines that are a day old.
void RemoveStaleTemporaries(const std::string& folder);

// Makes a folder if it is not there, removes such files from it, and throws
// Failure if files cannot be made in it. contents: what is written there, for
// the message.
void PrepareFolder(const std::string& path, const std::string& contents);

}  // namespace tapa

#endif  // TAPA_SRC_BASE_ATOMIC_FILE_H_
