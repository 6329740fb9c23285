#include "src/mvs/cuda/memory_share.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>

#include "src/mvs/cuda/memory.h"
#include "src/mvs/devices.h"

namespace tapa {
namespace {

// The shares of a GPU.
struct Shares {
  int num_settled = 0;
  bool is_one_settling = false;
};

std::mutex mutex;
std::condition_variable changed;
std::map<int, Shares> shares_of_device;

size_t FreeBytes() {
  size_t free_bytes = 0;
  size_t total_bytes = 0;
  CheckCuda(cudaMemGetInfo(&free_bytes, &total_bytes),
            "asking for the GPU's memory");
  return free_bytes;
}

std::string Megabytes(size_t bytes) {
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MB";
}

}  // namespace

MemoryShare::MemoryShare(int device, size_t bytes) : device_(device) {
  CheckCuda(cudaSetDevice(device), "choosing the GPU");
  std::unique_lock<std::mutex> lock(mutex);
  Shares& shares = shares_of_device[device];
  while (true) {
    changed.wait(lock, [&] { return !shares.is_one_settling; });
    const size_t free_bytes = FreeBytes();
    if (bytes <= free_bytes) {
      break;
    }
    if (shares.num_settled == 0) {
      throw DeviceMemoryError("it takes " + Megabytes(bytes) +
                              " of GPU memory and " + Megabytes(free_bytes) +
                              " are free");
    }
    changed.wait(lock);
  }
  shares.is_one_settling = true;
}

MemoryShare::~MemoryShare() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    Shares& shares = shares_of_device[device_];
    if (is_settled_) {
      --shares.num_settled;
    } else {
      shares.is_one_settling = false;
    }
  }
  changed.notify_all();
}

void MemoryShare::Settle() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    Shares& shares = shares_of_device[device_];
    shares.is_one_settling = false;
    ++shares.num_settled;
    is_settled_ = true;
  }
  changed.notify_all();
}

}  // namespace tapa
