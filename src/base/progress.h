#ifndef TAPA_SRC_BASE_PROGRESS_H_
#define TAPA_SRC_BASE_PROGRESS_H_

#include <functional>

namespace tapa {

// How work that takes long lets its caller follow and end it. Called often.

// Returns whether to continue.
using ContinueCheck = std::function<bool()>;

// Receives the share of the work that is done, 0 to 1. Returns whether to
// continue.
using ProgressCallback = std::function<bool(double)>;

}  // namespace tapa

#endif  // TAPA_SRC_BASE_PROGRESS_H_
