#include "src/mvs/cpu/memory_plan.h"

namespace tapa {

size_t CpuBackendMemory(const Options& options, const Problem& problem) {
  const size_t num_sources = problem.sources.size();
  const size_t pixels = problem.reference.image->size();
  size_t bytes = pixels * (sizeof(float) + sizeof(Vec3) + sizeof(uint8_t) +
                           2 * sizeof(uint16_t) * num_sources);
  if (options.filter || options.tapa.enabled) {
    bytes += pixels * ((num_sources + 7) / 8);
  }
  for (const View& view : problem.sources) {
    bytes += view.image->size() * sizeof(uint16_t);
  }
  return bytes;
}

}  // namespace tapa
