#ifndef TAPA_SRC_BASE_HASH_H_
#define TAPA_SRC_BASE_HASH_H_

#include <cstddef>
#include <cstdint>

namespace tapa {

// A number that tells contents apart (FNV-1a); not against those who mean to
// deceive.
class Hash {
 public:
  void Add(const void* data, size_t size) {
    const auto* bytes = static_cast<const uint8_t*>(data);
    for (size_t i = 0; i < size; ++i) {
      value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
    }
  }

  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace tapa

#endif  // TAPA_SRC_BASE_HASH_H_
