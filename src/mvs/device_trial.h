#ifndef TAPA_SRC_MVS_DEVICE_TRIAL_H_
#define TAPA_SRC_MVS_DEVICE_TRIAL_H_

#include <string>

#include "src/mvs/options.h"

namespace tapa {

// Whether a GPU computes what it should with these options, tried with a small
// problem whose solution is known: a driver may compile the kernels wrongly
// for a chip that is newer than this program. Takes a second at the most, most
// of it for the GPU to get ready.
//
// Returns what is wrong as half a sentence, or nothing if all is well.
std::string TryDevice(int device, Options options);

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEVICE_TRIAL_H_
