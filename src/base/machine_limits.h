#ifndef TAPA_SRC_BASE_MACHINE_LIMITS_H_
#define TAPA_SRC_BASE_MACHINE_LIMITS_H_

#include <string>

namespace tapa {

// What this process may use of the machine. A container or a batch job may be
// allowed less than there is: whatever is sized by the machine asks here.
struct MachineLimits {
  double memory_bytes = 0;
  int num_cpus = 1;
};

// The least of what the machine has, what the control groups (cgroups, of
// either version) that the process is in allow, and its own limit on the
// address space.
MachineLimits FindMachineLimits();

// Lowers limits to those of the control groups. root: where /proc and /sys are,
// for tests; as a rule "".
void ApplyCgroupLimits(const std::string& root, MachineLimits* limits);

}  // namespace tapa

#endif  // TAPA_SRC_BASE_MACHINE_LIMITS_H_
