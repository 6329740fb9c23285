#ifndef TAPA_SRC_MVS_HOST_DEVICE_H_
#define TAPA_SRC_MVS_HOST_DEVICE_H_

// Marks the functions that both backends share. They are always inlined: on the
// CPU that compiles them with the instruction set of the caller, which is
// chosen at run time; on a GPU it keeps their data in registers.
#if defined(__CUDACC__)
#define TAPA_INLINE __host__ __device__ __forceinline__
#else
#define TAPA_INLINE inline __attribute__((always_inline))
#endif

// Before a loop: how many of its rounds a GPU's code has one after the other.
#if defined(__CUDA_ARCH__)
#define TAPA_PRAGMA(text) _Pragma(#text)
#define TAPA_UNROLL(count) TAPA_PRAGMA(unroll count)
#else
#define TAPA_UNROLL(count)
#endif

// Whether this is code for a GPU, or for the one that tests emulate.
#if defined(__CUDA_ARCH__) || defined(TAPA_EMULATED_CUDA)
#define TAPA_ON_DEVICE
#endif

#endif  // TAPA_SRC_MVS_HOST_DEVICE_H_
