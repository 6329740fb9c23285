#include "src/base/read_at.h"

#include <unistd.h>

#include <cerrno>

namespace tapa {

int64_t ReadAt(int file, void* bytes, size_t size, uint64_t at) {
  size_t done = 0;
  while (done < size) {
    const ssize_t num_read = pread(file, static_cast<char*>(bytes) + done,
                                   size - done, static_cast<off_t>(at + done));
    if (num_read == 0) {
      break;
    }
    if (num_read > 0) {
      done += static_cast<size_t>(num_read);
    } else if (errno != EINTR) {
      return -1;
    }
  }
  return static_cast<int64_t>(done);
}

}  // namespace tapa
