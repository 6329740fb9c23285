#include "src/mvs/cuda/memory_share.h"

#include <condition_variable>
#include <map>
#include <mutex>
#include <string>

#include "src/mvs/cuda/memory.h"
#include "src/mvs/device_error.h"

namespace tapa {
namespace {

// The shares of a GPU.
struct Shares {
  int num_settled = 0;
  bool is_one_settling = false;
  int num_ended = 0;
};

std::mutex mutex;
std::condition_variable changed;
std::map<int, Shares> shares_of_device;

std::string Megabytes(size_t bytes) { return std::to_string(bytes >> 20); }

// Looks before anything is allocated, so that what is short is named.
void CheckMemory(size_t bytes) {
  size_t free_bytes = 0;
  size_t total_bytes = 0;
  CheckCuda(cudaMemGetInfo(&free_bytes, &total_bytes),
            "asking for the GPU's memory");
  const std::string needs =
      "it takes " + Megabytes(bytes + (1 << 20) - 1) + " MB of GPU memory";
  if (bytes > total_bytes) {
    throw DeviceLimitError(needs + ", of which there are " +
                           Megabytes(total_bytes));
  }
  if (bytes > free_bytes) {
    throw DeviceMemoryError(needs + ", of which " + Megabytes(free_bytes) +
                            " are free");
  }
}

}  // namespace

MemoryShare::MemoryShare(int device, size_t bytes) : device_(device) {
  CheckCuda(cudaSetDevice(device), "choosing the GPU");
  std::unique_lock<std::mutex> lock(mutex);
  Shares& shares = shares_of_device[device];
  changed.wait(lock, [&] { return !shares.is_one_settling; });
  CheckMemory(bytes);
  shares.is_one_settling = true;
}

MemoryShare::~MemoryShare() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    Shares& shares = shares_of_device[device_];
    if (is_settled_) {
      --shares.num_settled;
      ++shares.num_ended;
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

int MemoryShare::NumEnded(int device) {
  const std::lock_guard<std::mutex> lock(mutex);
  return shares_of_device[device].num_ended;
}

bool MemoryShare::WaitForEnd(int device, int num_ended) {
  std::unique_lock<std::mutex> lock(mutex);
  const Shares& shares = shares_of_device[device];
  const auto has_one_ended = [&] { return shares.num_ended != num_ended; };
  const auto is_none_left = [&] {
    return shares.num_settled == 0 && !shares.is_one_settling;
  };
  changed.wait(lock, [&] { return has_one_ended() || is_none_left(); });
  return has_one_ended();
}

}  // namespace tapa
