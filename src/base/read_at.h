#ifndef TAPA_SRC_BASE_READ_AT_H_
#define TAPA_SRC_BASE_READ_AT_H_

#include <cstddef>
#include <cstdint>

namespace tapa {

// Reads from a place of an open file, whatever signals come in between, and
// leaves the file's own place alone. Returns how many bytes there were, less
// than size at the end of the file, or -1 with errno.
int64_t ReadAt(int file, void* bytes, size_t size, uint64_t at);

}  // namespace tapa

#endif  // TAPA_SRC_BASE_READ_AT_H_
