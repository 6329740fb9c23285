#ifndef TAPA_SRC_MVS_CUDA_MEMORY_H_
#define TAPA_SRC_MVS_CUDA_MEMORY_H_

#include <cuda_runtime_api.h>

#include <cstddef>
#include <cstdint>
#include <utility>

#include "src/base/map.h"

namespace tapa {

// Owners of what CUDA hands out. All are used by the thread that made them,
// with its current device.

// Throws DeviceError or, if that is what it is, DeviceMemoryError that says
// what was done, if status is no success.
void CheckCuda(cudaError_t status, const char* what);

// Copies from memory that the system may move go on for a moment after the call
// returns, and streams do not wait for them by themselves.
void WaitForCopies();

// Bytes in device memory.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  explicit DeviceMemory(size_t bytes);
  ~DeviceMemory();
  DeviceMemory(DeviceMemory&& other) noexcept { *this = std::move(other); }
  DeviceMemory& operator=(DeviceMemory&& other) noexcept;

  void* data() const { return data_; }

 private:
  void* data_ = nullptr;
};

// An array of plain elements in device memory, uninitialized.
template <typename T>
class DeviceArray {
 public:
  DeviceArray() = default;
  explicit DeviceArray(size_t size) : memory_(size * sizeof(T)), size_(size) {}

  T* data() const { return static_cast<T*>(memory_.data()); }
  size_t size() const { return size_; }

  // Both wait for the copy, but not for kernels in streams.
  void Upload(const T* from, size_t count) {
    CheckCuda(
        cudaMemcpy(data(), from, count * sizeof(T), cudaMemcpyHostToDevice),
        "copying to the GPU");
    WaitForCopies();
  }
  void Download(T* to) const {
    CheckCuda(cudaMemcpy(to, data(), size_ * sizeof(T), cudaMemcpyDeviceToHost),
              "copying from the GPU");
  }

 private:
  DeviceMemory memory_;
  size_t size_ = 0;
};

// A texture's memory: one or more layers of the same size. T: uint8_t or float.
template <typename T>
class DeviceImage {
 public:
  DeviceImage() = default;
  // num_layers 0: no layers, a plain image.
  DeviceImage(int width, int height, int num_layers);
  ~DeviceImage();
  DeviceImage(DeviceImage&& other) noexcept { *this = std::move(other); }
  DeviceImage& operator=(DeviceImage&& other) noexcept;

  // The image may be smaller than the layer: the rest becomes 0.
  void Upload(const Map<T>& image, int layer);

  cudaArray_t array() const { return array_; }

 private:
  cudaArray_t array_ = nullptr;
  int width_ = 0;
  int height_ = 0;
};

// How a texture reads an image: 0 outside, coordinates in pixels whose centres
// are at integers plus one half.
enum class Reading {
  // The pixel that the place is in, as it is.
  kNearest,
  // Bilinear, integers scaled to 0 to 1.
  kBilinear,
};

class Texture {
 public:
  Texture() = default;
  Texture(cudaArray_t array, Reading reading);
  ~Texture();
  Texture(Texture&& other) noexcept { *this = std::move(other); }
  Texture& operator=(Texture&& other) noexcept;

  // 0: none.
  cudaTextureObject_t object() const { return object_; }

 private:
  cudaTextureObject_t object_ = 0;
};

class Stream {
 public:
  Stream();
  // Waits: after an error there may be work left, which uses what is given back
  // next.
  ~Stream();
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  cudaStream_t get() const { return stream_; }

 private:
  cudaStream_t stream_ = nullptr;
};

// A point in a stream's work that the host can wait for, asleep.
class Event {
 public:
  Event();
  ~Event();
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void Record(const Stream& stream);
  void Wait() const;

 private:
  cudaEvent_t event_ = nullptr;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CUDA_MEMORY_H_
