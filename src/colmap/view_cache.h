#ifndef TAPA_SRC_COLMAP_VIEW_CACHE_H_
#define TAPA_SRC_COLMAP_VIEW_CACHE_H_

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <unordered_map>

#include "src/base/map.h"

namespace tapa {

// Keeps what was read from files last, up to a number of bytes. What a caller
// still holds stays alive beyond that.
template <typename T>
class ViewCache {
 public:
  // read: reads the map of the view with an index.
  ViewCache(size_t max_bytes, std::function<Map<T>(int)> read)
      : max_bytes_(max_bytes), read_(std::move(read)) {}

  std::shared_ptr<const Map<T>> Get(int index) {
    const auto found = positions_.find(index);
    if (found != positions_.end()) {
      entries_.splice(entries_.begin(), entries_, found->second);
    } else {
      entries_.push_front(
          {index, std::make_shared<const Map<T>>(read_(index))});
      positions_[index] = entries_.begin();
      bytes_ += Bytes(entries_.front());
    }
    const std::shared_ptr<const Map<T>> map = entries_.front().map;
    while (bytes_ > max_bytes_ && !entries_.empty()) {
      bytes_ -= Bytes(entries_.back());
      positions_.erase(entries_.back().index);
      entries_.pop_back();
    }
    return map;
  }

 private:
  struct Entry {
    int index;
    std::shared_ptr<const Map<T>> map;
  };

  static size_t Bytes(const Entry& entry) {
    return entry.map->size() * sizeof(T);
  }

  const size_t max_bytes_;
  const std::function<Map<T>(int)> read_;
  size_t bytes_ = 0;
  // The last used one first.
  std::list<Entry> entries_;
  std::unordered_map<int, typename std::list<Entry>::iterator> positions_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_VIEW_CACHE_H_
