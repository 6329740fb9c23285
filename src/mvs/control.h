#ifndef TAPA_SRC_MVS_CONTROL_H_
#define TAPA_SRC_MVS_CONTROL_H_

#include <functional>

namespace tapa {

struct TapaRecord;

// How a caller follows and ends a running estimation. Both are called often,
// from the calling thread or another one, never from two at a time.
struct Control {
  // Receives the share of the work that is done, 0 to 1.
  std::function<void(double)> progress;
  // Returns true to end the estimation within a fraction of a second.
  std::function<bool()> stopped;
  // Filled with what TAPA did, if it runs.
  TapaRecord* record = nullptr;

  bool IsStopped() const { return stopped && stopped(); }
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CONTROL_H_
