#ifndef TAPA_SRC_MVS_DEVICES_H_
#define TAPA_SRC_MVS_DEVICES_H_

#include <string>
#include <vector>

namespace tapa {

// The GPUs of this machine, numbered from 0 as CUDA numbers them.
struct DeviceList {
  struct Device {
    std::string name;
    // Empty, or why the engine cannot compute on it.
    std::string unusable;
  };
  std::vector<Device> devices;
  // Why there is none that can be used, as half a sentence; empty: there is.
  std::string why_none;
};

// Never fails: without CUDA in the program, a driver or a device it says so.
DeviceList FindDevices();

}  // namespace tapa

#endif  // TAPA_SRC_MVS_DEVICES_H_
