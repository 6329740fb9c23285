#include "tests/mvs/emulated_cuda/state.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

namespace emulated_cuda {
namespace {

size_t FromEnvironment(const char* name, size_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

Settings SettingsOfEnvironment() {
  Settings settings;
  settings.memory_bytes =
      FromEnvironment("EMULATED_GPU_MEMORY_KB", settings.memory_bytes >> 10)
      << 10;
  settings.failing_call =
      static_cast<int>(FromEnvironment("EMULATED_GPU_FAILING_CALL", 0));
  settings.fails_for_good = true;
  settings.black_textures =
      FromEnvironment("EMULATED_GPU_BLACK_TEXTURES", 0) != 0;
  return settings;
}

}  // namespace

State& GetState() {
  static State* const state = [] {
    auto* const made = new State;
    made->settings = SettingsOfEnvironment();
    return made;
  }();
  return *state;
}

void Reset(const Settings& settings) {
  State& state = GetState();
  const std::lock_guard<std::recursive_mutex> lock(state.mutex);
  state.settings = settings;
  state.usage = Usage();
  state.random.seed(settings.turns);
  state.max_shared_bytes.clear();
}

Usage GetUsage() {
  State& state = GetState();
  const std::lock_guard<std::recursive_mutex> lock(state.mutex);
  return state.usage;
}

void State::RunSomeWork() {
  while (settings.turns != 0 && random() % 2 == 0) {
    const size_t i = random() % (streams.size() + 1);
    (i == streams.size() ? &default_stream : *std::next(streams.begin(), i))
        ->RunOne();
  }
}

void State::RunAllWork() {
  default_stream.RunAll();
  for (const cudaStream_t stream : streams) {
    stream->RunAll();
  }
}

bool State::Take(size_t bytes) {
  if (usage.bytes + bytes > settings.memory_bytes) {
    return false;
  }
  ++usage.num_objects;
  usage.bytes += bytes;
  usage.peak_bytes = std::max(usage.peak_bytes, usage.bytes);
  return true;
}

void State::GiveBack(size_t bytes) {
  --usage.num_objects;
  usage.bytes -= bytes;
}

}  // namespace emulated_cuda
