#ifndef TAPA_TESTS_MVS_EMULATED_CUDA_TEXTURES_H_
#define TAPA_TESTS_MVS_EMULATED_CUDA_TEXTURES_H_

#include "tests/mvs/emulated_cuda/cuda_runtime_api.h"

namespace emulated_cuda {

constexpr int kNoLayers = -1;

// What a texture unit gives at a place, in pixels whose centres are at integers
// plus one half. Throws std::logic_error for what is undefined: an object that
// is none, another type than the texture's, a layer that is not there.
template <typename T>
T FetchTexture(cudaTextureObject_t object, float x, float y, int layer);

extern template float FetchTexture<float>(cudaTextureObject_t, float, float,
                                          int);
extern template unsigned char FetchTexture<unsigned char>(cudaTextureObject_t,
                                                          float, float, int);

}  // namespace emulated_cuda

#endif  // TAPA_TESTS_MVS_EMULATED_CUDA_TEXTURES_H_
