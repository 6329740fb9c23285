#ifndef TAPA_SRC_MVS_CUDA_MEMORY_SHARE_H_
#define TAPA_SRC_MVS_CUDA_MEMORY_SHARE_H_

#include <cstddef>

namespace tapa {

// What a backend takes of a GPU's memory. Backends of several threads take it
// one after the other, so that nobody takes what another has found free.
class MemoryShare {
 public:
  // Chooses the GPU for this thread. Throws DeviceMemoryError if so much is not
  // free, DeviceLimitError if there is no such memory at all.
  MemoryShare(int device, size_t bytes);
  ~MemoryShare();
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  // To be called once everything is allocated; others wait for it.
  void Settle();

  // How many of the GPU's shares have ended so far.
  static int NumEnded(int device);

  // Waits until more of the GPU's shares than that have ended; returns false if
  // there is none left that could end.
  static bool WaitForEnd(int device, int num_ended);

 private:
  const int device_;
  bool is_settled_ = false;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_MEMORY_SHARE_H_
