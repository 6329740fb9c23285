#include "src/mvs/cuda/memory.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>

#include "src/mvs/device_error.h"

namespace tapa {

void CheckCuda(cudaError_t status, const char* what) {
  if (status != cudaSuccess) {
    const std::string message =
        std::string(what) + ": " + cudaGetErrorString(status);
    if (status == cudaErrorMemoryAllocation) {
      throw DeviceMemoryError(message);
    }
    throw DeviceError(message);
  }
}

void WaitForCopies() {
  CheckCuda(cudaStreamSynchronize(nullptr), "copying to the GPU");
}

DeviceMemory::DeviceMemory(size_t bytes) {
  if (bytes > 0) {
    CheckCuda(cudaMalloc(&data_, bytes), "allocating memory of the GPU");
  }
}

DeviceMemory::~DeviceMemory() { cudaFree(data_); }

DeviceMemory& DeviceMemory::operator=(DeviceMemory&& other) noexcept {
  std::swap(data_, other.data_);
  return *this;
}

template <typename T>
DeviceImage<T>::DeviceImage(int width, int height, int num_layers)
    : width_(width), height_(height) {
  const cudaChannelFormatDesc format = {8 * sizeof(T), 0, 0, 0,
                                        std::is_same<T, float>::value
                                            ? cudaChannelFormatKindFloat
                                            : cudaChannelFormatKindUnsigned};
  const cudaError_t status = cudaMalloc3DArray(
      &array_, &format, make_cudaExtent(width, height, num_layers),
      num_layers > 0 ? cudaArrayLayered : cudaArrayDefault);
  if (status == cudaErrorInvalidValue) {
    throw DeviceLimitError(
        "its images are too large, or too many, for the GPU's textures");
  }
  CheckCuda(status, "allocating images on the GPU");
}

template <typename T>
DeviceImage<T>::~DeviceImage() {
  cudaFreeArray(array_);
}

template <typename T>
DeviceImage<T>& DeviceImage<T>::operator=(DeviceImage&& other) noexcept {
  std::swap(array_, other.array_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  return *this;
}

template <typename T>
void DeviceImage<T>::Upload(const Map<T>& image, int layer) {
  Map<T> padded;
  const Map<T>* from = &image;
  if (image.width() != width_ || image.height() != height_) {
    padded = Map<T>(width_, height_, 0);
    for (int row = 0; row < image.height(); ++row) {
      std::copy(image.Row(row), image.Row(row) + image.width(),
                padded.Row(row));
    }
    from = &padded;
  }
  cudaMemcpy3DParms copy = {};
  copy.srcPtr = make_cudaPitchedPtr(const_cast<T*>(from->data()),
                                    width_ * sizeof(T), width_, height_);
  copy.dstArray = array_;
  copy.dstPos = make_cudaPos(0, 0, layer);
  copy.extent = make_cudaExtent(width_, height_, 1);
  copy.kind = cudaMemcpyHostToDevice;
  CheckCuda(cudaMemcpy3D(&copy), "copying images to the GPU");
  WaitForCopies();
}

template class DeviceImage<uint8_t>;
template class DeviceImage<float>;

Texture::Texture(cudaArray_t array, Reading reading) {
  cudaResourceDesc resource = {};
  resource.resType = cudaResourceTypeArray;
  resource.res.array.array = array;
  cudaTextureDesc description = {};
  for (cudaTextureAddressMode& mode : description.addressMode) {
    mode = cudaAddressModeBorder;
  }
  const bool bilinear = reading == Reading::kBilinear;
  description.filterMode =
      bilinear ? cudaFilterModeLinear : cudaFilterModePoint;
  description.readMode =
      bilinear ? cudaReadModeNormalizedFloat : cudaReadModeElementType;
  CheckCuda(cudaCreateTextureObject(&object_, &resource, &description, nullptr),
            "making a texture");
}

Texture::~Texture() {
  if (object_ != 0) {
    cudaDestroyTextureObject(object_);
  }
}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(object_, other.object_);
  return *this;
}

Stream::Stream() {
  CheckCuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking),
            "making a stream");
}

Stream::~Stream() {
  if (stream_ != nullptr) {
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }
}

Event::Event() {
  CheckCuda(cudaEventCreateWithFlags(
                &event_, cudaEventBlockingSync | cudaEventDisableTiming),
            "making an event");
}

Event::~Event() { cudaEventDestroy(event_); }

void Event::Record(const Stream& stream) {
  CheckCuda(cudaEventRecord(event_, stream.get()), "recording an event");
}

void Event::Wait() const {
  CheckCuda(cudaEventSynchronize(event_), "computing on the GPU");
}

}  // namespace tapa
