#include "src/base/peak_memory.h"

#include <cstdio>
#include <fstream>

#include "src/base/machine_limits.h"

namespace tapa {

// getrusage would count what a parent held before it started this program.
double PeakMemory() {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    double kilobytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %lf kB", &kilobytes) == 1) {
      return 1024 * kilobytes;
    }
  }
  return 0;
}

std::string DescribePeakMemory() {
  constexpr double kMegabyte = 1 << 20;
  char text[128];
  std::snprintf(text, sizeof(text),
                "Peak memory: %.0f MB of %.0f MB that this process may use",
                PeakMemory() / kMegabyte,
                FindMachineLimits().memory_bytes / kMegabyte);
  return text;
}

}  // namespace tapa
