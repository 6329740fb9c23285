#ifndef TAPA_SRC_BASE_INLINE_H_
#define TAPA_SRC_BASE_INLINE_H_

// Marks functions for host and device. They are always inlined: on the CPU that
// compiles them with the instruction set of the caller, which is chosen at run
// time; on a GPU it keeps their data in registers.
#if defined(__CUDACC__)
#define TAPA_INLINE __host__ __device__ __forceinline__
#else
#define TAPA_INLINE inline __attribute__((always_inline))
#endif

#endif  // TAPA_SRC_BASE_INLINE_H_
