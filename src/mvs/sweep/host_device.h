#ifndef TAPA_SRC_MVS_SWEEP_HOST_DEVICE_H_
#define TAPA_SRC_MVS_SWEEP_HOST_DEVICE_H_

#include "src/base/inline.h"

// What this folder holds: all that a pixel does in a sweep, written once and
// compiled for host and device. What runs on a device is TAPA_INLINE, works on
// plain data, and neither allocates memory nor throws; memory comes from the
// backend. Headers here include only each other and src/base. Without
// TAPA_INLINE are a few functions that prepare sweeps on the host.

// Before a loop: how many of its rounds a GPU's code has one after the other.
#if defined(__CUDA_ARCH__)
#define TAPA_PRAGMA(text) _Pragma(#text)
#define TAPA_UNROLL(count) TAPA_PRAGMA(unroll count)
#else
#define TAPA_UNROLL(count)
#endif

// Before a loop whose rounds do not depend on each other.
#if defined(__CUDACC__)
#define TAPA_INDEPENDENT_ITERATIONS
#else
#define TAPA_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#endif

// Whether this is code for a GPU, or for the one that tests emulate.
#if defined(__CUDA_ARCH__) || defined(TAPA_EMULATED_CUDA)
#define TAPA_ON_DEVICE
#endif

#endif  // TAPA_SRC_MVS_SWEEP_HOST_DEVICE_H_
