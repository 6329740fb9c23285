#ifndef TAPA_SRC_MVS_DEVICE_ERROR_H_
#define TAPA_SRC_MVS_DEVICE_ERROR_H_

#include <stdexcept>

namespace tapa {

// A GPU does not work, or has too little memory for a problem. The same problem
// can be computed on the CPU.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A problem is too large for the GPU, which can compute others.
class DeviceLimitError : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

// It takes more memory than is free just now.
class DeviceMemoryError : public DeviceLimitError {
 public:
  using DeviceLimitError::DeviceLimitError;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEVICE_ERROR_H_
