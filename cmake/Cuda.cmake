# Finds CUDA's compiler and says, in TAPA_CUDA, whether the CUDA backend is
# built. COLMAP's own CUDA code is not built in any case.

set(TAPA_WITH_CUDA AUTO CACHE STRING
    "Build the CUDA backend: ON, OFF, or AUTO (where nvcc 12 or newer is found)")
set_property(CACHE TAPA_WITH_CUDA PROPERTY STRINGS AUTO ON OFF)

set(TAPA_CUDA OFF)
if(TAPA_WITH_CUDA)
  if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
    # Beyond PATH: where NVIDIA's installers put it.
    find_program(TAPA_NVCC nvcc HINTS ENV CUDA_PATH ENV CUDA_HOME
      PATHS /usr/local/cuda /opt/cuda PATH_SUFFIXES bin)
    mark_as_advanced(TAPA_NVCC)
    if(TAPA_NVCC)
      set(CMAKE_CUDA_COMPILER ${TAPA_NVCC})
    endif()
  endif()
  # Code for Turing, and Ampere with Ada, which runs the same; and for Hopper,
  # with PTX, which the driver compiles for whatever comes after.
  if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
    set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90 CACHE STRING
        "Architectures that CUDA code is compiled for")
  endif()
  set(CMAKE_CUDA_STANDARD 17)
  set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  # One program for all machines.
  set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    enable_language(CUDA)
    if(CMAKE_CUDA_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
      set(TAPA_CUDA ON)
    endif()
  endif()
  if(NOT TAPA_CUDA AND NOT TAPA_WITH_CUDA STREQUAL "AUTO")
    message(FATAL_ERROR "TAPA_WITH_CUDA is ${TAPA_WITH_CUDA}, but there is no \
nvcc of CUDA 12 or newer. Name it with -DCMAKE_CUDA_COMPILER=...")
  endif()
endif()
if(TAPA_CUDA)
  message(STATUS "CUDA backend: yes, with CUDA ${CMAKE_CUDA_COMPILER_VERSION} \
for ${CMAKE_CUDA_ARCHITECTURES}")
else()
  message(STATUS "CUDA backend: no")
endif()
