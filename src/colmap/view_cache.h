#ifndef TAPA_SRC_COLMAP_VIEW_CACHE_H_
#define TAPA_SRC_COLMAP_VIEW_CACHE_H_

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>

#include "src/base/map.h"

namespace tapa {

// How often something was asked for, and was in memory already.
struct CacheUse {
  size_t num_asked = 0;
  size_t num_found = 0;

  // Such as "95 % of 1234 depth maps".
  std::string Describe(const std::string& what) const {
    const size_t percent = num_asked > 0 ? 100 * num_found / num_asked : 100;
    return std::to_string(percent) + " % of " + std::to_string(num_asked) +
           " " + what;
  }
};

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
    ++use_.num_asked;
    if (found != positions_.end()) {
      ++use_.num_found;
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

  const CacheUse& Use() const { return use_; }

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
  CacheUse use_;
  // The last used one first.
  std::list<Entry> entries_;
  std::unordered_map<int, typename std::list<Entry>::iterator> positions_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_VIEW_CACHE_H_
