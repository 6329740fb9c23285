#include "tests/mvs/emulated_cuda/textures.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "tests/mvs/emulated_cuda/state.h"

namespace emulated_cuda {
namespace {

// Where a texture is read.
struct Place {
  const Texture& texture;
  size_t layer;
};

// Element of the array, 0 outside.
float Element(const Place& place, float col, float row) {
  const cudaArray& array = *place.texture.array;
  if (!(col >= 0 && row >= 0 && col < array.width && row < array.height)) {
    return 0;
  }
  const size_t index =
      (place.layer * array.height + static_cast<size_t>(row)) * array.width +
      static_cast<size_t>(col);
  if (array.kind == cudaChannelFormatKindUnsigned) {
    return array.bytes[index];
  }
  float value;
  std::memcpy(&value, array.bytes.data() + index * sizeof(value),
              sizeof(value));
  return value;
}

// The share of the higher of two neighbours.
float Fraction(float x) {
  const float fraction = x - std::floor(x);
  return GetState().settings.exact_filtering
             ? fraction
             : std::floor(fraction * 256 + 0.5f) / 256;
}

float Bilinear(const Place& place, float x, float y) {
  const float col = std::floor(x - 0.5f);
  const float row = std::floor(y - 0.5f);
  const float a = Fraction(x - 0.5f);
  const float b = Fraction(y - 0.5f);
  return (1 - a) * (1 - b) * Element(place, col, row) +
         a * (1 - b) * Element(place, col + 1, row) +
         (1 - a) * b * Element(place, col, row + 1) +
         a * b * Element(place, col + 1, row + 1);
}

template <typename T>
void CheckUse(const Texture& texture, int layer) {
  const cudaTextureDesc& description = texture.description;
  const cudaArray& array = *texture.array;
  const bool normalized = description.readMode == cudaReadModeNormalizedFloat;
  if (sizeof(T) != (normalized ? sizeof(float) : array.bytes_per_element)) {
    throw std::logic_error("a texture is read as another type");
  }
  if (description.filterMode == cudaFilterModeLinear && sizeof(T) == 1) {
    throw std::logic_error("a texture of integers is filtered");
  }
  const bool layered = array.num_layers > 0;
  if (layered != (layer >= 0) ||
      (layered && static_cast<size_t>(layer) >= array.num_layers)) {
    throw std::logic_error("a texture has no such layer");
  }
}

}  // namespace

template <typename T>
T FetchTexture(cudaTextureObject_t object, float x, float y, int layer) {
  const State& state = GetState();
  const auto found = state.textures.find(object);
  if (found == state.textures.end()) {
    throw std::logic_error("a texture is read that is none");
  }
  const Texture& texture = found->second;
  CheckUse<T>(texture, layer);
  if (state.settings.black_textures || !std::isfinite(x) || !std::isfinite(y)) {
    return 0;
  }
  const Place place = {texture, layer < 0 ? 0 : static_cast<size_t>(layer)};
  const float value = texture.description.filterMode == cudaFilterModeLinear
                          ? Bilinear(place, x, y)
                          : Element(place, std::floor(x), std::floor(y));
  const bool normalized =
      texture.description.readMode == cudaReadModeNormalizedFloat;
  return static_cast<T>(normalized ? value / 255 : value);
}

template float FetchTexture<float>(cudaTextureObject_t, float, float, int);
template unsigned char FetchTexture<unsigned char>(cudaTextureObject_t, float,
                                                   float, int);

}  // namespace emulated_cuda

using emulated_cuda::Call;
using emulated_cuda::CallToGiveBack;
using emulated_cuda::State;

cudaError_t cudaCreateTextureObject(cudaTextureObject_t* object,
                                    const cudaResourceDesc* resource,
                                    const cudaTextureDesc* description,
                                    const void* view) {
  return Call([&](State* state) {
    const cudaArray* const array = resource->res.array.array;
    // The emulated units know no more than the backend uses.
    if (resource->resType != cudaResourceTypeArray || array == nullptr ||
        view != nullptr || description->normalizedCoords != 0 ||
        (description->readMode == cudaReadModeNormalizedFloat &&
         array->kind != cudaChannelFormatKindUnsigned)) {
      return cudaErrorInvalidValue;
    }
    for (const cudaTextureAddressMode mode : description->addressMode) {
      if (mode != cudaAddressModeBorder) {
        return cudaErrorInvalidValue;
      }
    }
    state->Take(0);
    *object = ++state->last_texture;
    state->textures.insert({*object, {array, *description}});
    return cudaSuccess;
  });
}

cudaError_t cudaDestroyTextureObject(cudaTextureObject_t object) {
  return CallToGiveBack([&](State* state) {
    if (state->textures.erase(object) > 0) {
      state->GiveBack(0);
    }
  });
}
