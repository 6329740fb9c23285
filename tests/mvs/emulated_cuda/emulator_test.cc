// The emulated GPU finds the mistakes that it is there for.

#include "tests/mvs/emulated_cuda/emulator.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/mvs/emulated_cuda/cuda_runtime.h"

namespace tapa {

extern __shared__ __align__(16) float shared_words[];

namespace {

using emulated_cuda::RunBlock;
using emulated_cuda::RunWarp;

constexpr unsigned kAll = 0xFFFFFFFF;

TEST(EmulatedThreads, ThatMissEachOtherAreAnError) {
  EXPECT_THROW(RunWarp(0,
                       [] {
                         if (threadIdx.x != 7) {
                           __syncwarp();
                         }
                       }),
               std::logic_error);
  EXPECT_THROW(RunWarp(0,
                       [] {
                         if (threadIdx.x < 16) {
                           __syncwarp();
                         } else {
                           __shfl_sync(kAll, 0.0f, 16);
                         }
                       }),
               std::logic_error);
  EXPECT_THROW(RunWarp(0,
                       [] {
                         const bool even = threadIdx.x % 2 == 0;
                         __shfl_xor_sync(kAll, 0.0f, even ? 2 : 4);
                       }),
               std::logic_error);
  EXPECT_THROW(RunBlock(0, 64, 0, 0,
                        [] {
                          if (threadIdx.x < 32) {
                            __syncthreads();
                          }
                        }),
               std::logic_error);
}

TEST(EmulatedThreads, ShuffleAmongTheirGroup) {
  for (const uint32_t turns : {0, 3}) {
    RunWarp(turns, [] {
      const int lane = threadIdx.x;
      const unsigned group = 0xFu << (lane / 4 * 4);
      // Groups go on by themselves, as often as they like.
      for (int i = 0; i <= lane / 4; ++i) {
        EXPECT_EQ(__shfl_sync(group, 10 * lane + i, lane ^ 1),
                  10 * (lane ^ 1) + i);
      }
    });
  }
  const auto ask = [](unsigned mask, int source) {
    RunWarp(0, [=] { __shfl_sync(mask, 0, source); });
  };
  EXPECT_NO_THROW(ask(kAll, 31));
  EXPECT_THROW(ask(kAll, 32), std::logic_error);
  // Most lanes are not in the mask that they name.
  EXPECT_THROW(ask(0xF, 0), std::logic_error);
}

TEST(EmulatedThreads, ShowAMissingSync) {
  const auto neighbours = [](uint32_t turns, bool sync) {
    std::vector<int> seen(128);
    RunBlock(0, 128, 128 * sizeof(float), turns, [&] {
      const int i = threadIdx.x;
      shared_words[i] = i;
      if (sync) {
        __syncthreads();
      }
      const float neighbour = shared_words[(i + 1) % 128];
      // Not a number: nobody has written it yet.
      seen[i] = neighbour == neighbour ? static_cast<int>(neighbour) : -1;
    });
    return seen;
  };
  EXPECT_EQ(neighbours(0, true), neighbours(5, true));
  EXPECT_NE(neighbours(0, false), neighbours(5, false));
}

TEST(EmulatedThreads, WriteBeyondSharedMemoryIsAnError) {
  const auto write = [](int word) {
    RunBlock(0, 32, 10 * sizeof(float), 0, [=] { shared_words[word] = 1; });
  };
  EXPECT_NO_THROW(write(9));
  EXPECT_THROW(write(10), std::logic_error);
}

void AddOne(int* value) {
  if (threadIdx.x == 0) {
    ++*value;
  }
}

class EmulatedMemory : public testing::Test {
 protected:
  void SetUp() override {
    emulated_cuda::Reset({});
    ASSERT_EQ(cudaMalloc(&value_, sizeof(int)), cudaSuccess);
    ASSERT_EQ(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking),
              cudaSuccess);
  }
  void TearDown() override {
    cudaStreamDestroy(stream_);
    cudaFree(value_);
    EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0);
  }

  cudaError_t LaunchAddOne(size_t shared_bytes = 0) {
    cudaLaunchConfig_t config = {};
    config.gridDim = 1;
    config.blockDim = 32;
    config.dynamicSmemBytes = shared_bytes;
    config.stream = stream_;
    return cudaLaunchKernelEx(&config, AddOne, value_);
  }

  int Download() {
    int value = 0;
    cudaMemcpy(&value, value_, sizeof(value), cudaMemcpyDeviceToHost);
    return value;
  }

  void Upload(int value) {
    cudaMemcpy(value_, &value, sizeof(value), cudaMemcpyHostToDevice);
  }

  int* value_ = nullptr;
  cudaStream_t stream_ = nullptr;
};

TEST_F(EmulatedMemory, ArrivesOnceSomebodyWaits) {
  Upload(4);
  LaunchAddOne();
  // Nobody waited for the kernel.
  EXPECT_EQ(Download(), 4);
  cudaStreamSynchronize(stream_);
  EXPECT_EQ(Download(), 5);
  // The kernel does not wait for the copy.
  Upload(10);
  LaunchAddOne();
  cudaStreamSynchronize(stream_);
  EXPECT_EQ(Download(), 10);
}

TEST_F(EmulatedMemory, EventsWaitForWhatWasBefore) {
  Upload(0);
  cudaStreamSynchronize(nullptr);
  cudaEvent_t event;
  cudaEventCreateWithFlags(&event, cudaEventDisableTiming);
  EXPECT_EQ(cudaEventSynchronize(event), cudaSuccess);
  LaunchAddOne();
  cudaEventRecord(event, stream_);
  LaunchAddOne();
  cudaEventSynchronize(event);
  EXPECT_EQ(Download(), 1);
  cudaEventDestroy(event);
}

using EmulatedMemoryDeathTest = EmulatedMemory;

TEST_F(EmulatedMemoryDeathTest, IsOutOfReachForTheHost) {
  EXPECT_DEATH(*static_cast<volatile int*>(value_) = 1, "");
}

TEST_F(EmulatedMemoryDeathTest, EndsWhereItEnds) {
  // The emulated pieces begin at multiples of 16 bytes.
  value_ += 4;
  EXPECT_DEATH(
      {
        LaunchAddOne();
        cudaStreamSynchronize(stream_);
      },
      "");
  value_ -= 4;
}

TEST_F(EmulatedMemory, HasAnEnd) {
  emulated_cuda::Settings settings;
  settings.memory_bytes = 100;
  TearDown();
  emulated_cuda::Reset(settings);
  char* most = nullptr;
  char* more = nullptr;
  EXPECT_EQ(cudaMalloc(&most, 90), cudaSuccess);
  EXPECT_EQ(cudaMalloc(&more, 11), cudaErrorMemoryAllocation);
  EXPECT_EQ(more, nullptr);
  EXPECT_EQ(emulated_cuda::GetUsage().peak_bytes, 90);
  cudaFree(most);
  SetUp();
}

TEST_F(EmulatedMemory, LaunchesNeedLeaveForMuchSharedMemory) {
  constexpr int kMuch = 60 * 1024;
  EXPECT_EQ(LaunchAddOne(48 * 1024), cudaSuccess);
  EXPECT_EQ(LaunchAddOne(kMuch), cudaErrorInvalidValue);
  const void* const kernel = reinterpret_cast<const void*>(AddOne);
  EXPECT_EQ(cudaFuncSetAttribute(
                kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, kMuch),
            cudaSuccess);
  EXPECT_EQ(LaunchAddOne(kMuch), cudaSuccess);
}

TEST(EmulatedCalls, FailWhereTheyShall) {
  emulated_cuda::Settings settings;
  settings.failing_call = 2;
  for (const bool for_good : {false, true}) {
    settings.fails_for_good = for_good;
    emulated_cuda::Reset(settings);
    int device = 0;
    EXPECT_EQ(cudaGetDevice(&device), cudaSuccess);
    EXPECT_EQ(cudaGetDevice(&device), cudaErrorLaunchFailure);
    EXPECT_EQ(cudaGetDevice(&device),
              for_good ? cudaErrorLaunchFailure : cudaSuccess);
  }
}

// Two layers of 3 x 2 pixels, 10 * layer + pixel.
class EmulatedTexture : public testing::Test {
 protected:
  cudaTextureObject_t Make(cudaTextureReadMode read_mode) {
    const cudaChannelFormatDesc format = {8, 0, 0, 0,
                                          cudaChannelFormatKindUnsigned};
    cudaMalloc3DArray(&array_, &format, make_cudaExtent(3, 2, 2),
                      cudaArrayLayered);
    for (int layer = 0; layer < 2; ++layer) {
      unsigned char pixels[6];
      for (int i = 0; i < 6; ++i) {
        pixels[i] = static_cast<unsigned char>(10 * layer + i);
      }
      cudaMemcpy3DParms copy = {};
      copy.srcPtr = make_cudaPitchedPtr(pixels, 3, 3, 2);
      copy.dstArray = array_;
      copy.dstPos = make_cudaPos(0, 0, layer);
      copy.extent = make_cudaExtent(3, 2, 1);
      copy.kind = cudaMemcpyHostToDevice;
      EXPECT_EQ(cudaMemcpy3D(&copy), cudaSuccess);
    }
    cudaStreamSynchronize(nullptr);
    cudaResourceDesc resource = {};
    resource.res.array.array = array_;
    cudaTextureDesc description = {};
    for (cudaTextureAddressMode& mode : description.addressMode) {
      mode = cudaAddressModeBorder;
    }
    description.readMode = read_mode;
    description.filterMode = read_mode == cudaReadModeElementType
                                 ? cudaFilterModePoint
                                 : cudaFilterModeLinear;
    EXPECT_EQ(
        cudaCreateTextureObject(&object_, &resource, &description, nullptr),
        cudaSuccess);
    return object_;
  }

  void SetUp() override { emulated_cuda::Reset({}); }
  void TearDown() override {
    cudaDestroyTextureObject(object_);
    cudaFreeArray(array_);
    EXPECT_EQ(emulated_cuda::GetUsage().num_objects, 0);
  }

  cudaArray_t array_ = nullptr;
  cudaTextureObject_t object_ = 0;
};

TEST_F(EmulatedTexture, ReadsPixels) {
  const cudaTextureObject_t object = Make(cudaReadModeElementType);
  const auto at = [&](float x, float y, int layer) -> int {
    return tex2DLayered<unsigned char>(object, x, y, layer);
  };
  EXPECT_EQ(at(0.5f, 0.5f, 1), 10);
  EXPECT_EQ(at(2.99f, 1.0f, 0), 5);
  EXPECT_EQ(at(3.0f, 1.0f, 0), 0);
  EXPECT_EQ(at(-0.01f, 1.0f, 1), 0);
  EXPECT_EQ(at(NAN, 1.0f, 1), 0);
  EXPECT_THROW(at(0, 0, 2), std::logic_error);
  EXPECT_THROW(tex2D<unsigned char>(object, 0, 0), std::logic_error);
  EXPECT_THROW(tex2DLayered<float>(object, 0, 0, 0), std::logic_error);
  EXPECT_THROW(tex2DLayered<float>(object + 1, 0, 0, 0), std::logic_error);
}

TEST_F(EmulatedTexture, Filters) {
  const cudaTextureObject_t object = Make(cudaReadModeNormalizedFloat);
  const auto at = [&](float x, float y) {
    return 255 * tex2DLayered<float>(object, x, y, 1);
  };
  EXPECT_NEAR(at(0.5f, 0.5f), 10, 1e-5);
  EXPECT_NEAR(at(1.75f, 1.0f), 12.75f, 1e-5);
  // Half of it is outside.
  EXPECT_NEAR(at(3.0f, 0.5f), 6, 1e-5);
  // 1 / 512 rounds to 1 / 256.
  EXPECT_NEAR(at(0.5f + 1.0f / 512, 0.5f), 10 + 1.0f / 256, 1e-5);
}

}  // namespace
}  // namespace tapa
