#include "src/mvs/cpu/memory_plan.h"

#include "src/mvs/schedule.h"
#include "src/mvs/sweep/consistency_mask.h"

namespace tapa {

size_t CpuBackendMemory(const Options& options, const Problem& problem) {
  const int num_sources = static_cast<int>(problem.sources.size());
  const size_t pixels = problem.reference.image->size();
  size_t bytes = pixels * (sizeof(float) + sizeof(Vec3) + sizeof(uint8_t) +
                           2 * sizeof(uint16_t) * num_sources);
  if (Schedule::ChecksConsistency(options)) {
    bytes += pixels * ConsistencyMaskBytes(num_sources);
  }
  for (const View& view : problem.sources) {
    bytes += view.image->size() * sizeof(uint16_t);
  }
  return bytes;
}

}  // namespace tapa
