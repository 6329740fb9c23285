#ifndef TAPA_SRC_MVS_DEVICE_TRIAL_H_
#define TAPA_SRC_MVS_DEVICE_TRIAL_H_

#include <functional>
#include <string>

#include "src/mvs/options.h"

namespace tapa {

// Whether a GPU sweeps as the CPU does, tried with a small photometric problem
// and the kernel that these options take: a driver may compile kernels wrongly
// for a chip that is newer than this program, which also takes some seconds the
// first time.
//
// Returns what is wrong as half a sentence, or nothing if all is well or
// stopped() was true.
std::string TryDevice(int device, const Options& wanted,
                      const std::function<bool()>& stopped = nullptr);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEVICE_TRIAL_H_
