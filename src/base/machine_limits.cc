#include "src/base/machine_limits.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace tapa {
namespace {

// The first numbers of a file, as many as there are: none if there is no such
// file, or if it says "max", by which cgroups mean that there is no limit.
std::vector<double> ReadNumbers(const std::string& path) {
  std::ifstream file(path);
  std::vector<double> numbers;
  for (double number; file >> number;) {
    numbers.push_back(number);
  }
  return numbers;
}

void LowerMemory(const std::vector<double>& bytes, MachineLimits* limits) {
  if (!bytes.empty() && bytes[0] > 0) {
    limits->memory_bytes = std::min(limits->memory_bytes, bytes[0]);
  }
}

// quota: CPU time per period; without one there is no limit, for which -1
// stands, too.
void LowerCpus(const std::vector<double>& quota,
               const std::vector<double>& period, MachineLimits* limits) {
  if (!quota.empty() && !period.empty() && quota[0] > 0 && period[0] > 0) {
    const double cpus = std::ceil(quota[0] / period[0]);
    limits->num_cpus = static_cast<int>(
        std::clamp(cpus, 1.0, static_cast<double>(limits->num_cpus)));
  }
}

// The limits of one group. folder: of its files, whichever controllers it has.
void ApplyGroup(const std::string& folder, MachineLimits* limits) {
  LowerMemory(ReadNumbers(folder + "/memory.max"), limits);
  const std::vector<double> cpu = ReadNumbers(folder + "/cpu.max");
  if (cpu.size() == 2) {
    LowerCpus({cpu[0]}, {cpu[1]}, limits);
  }
  // Version 1.
  LowerMemory(ReadNumbers(folder + "/memory.limit_in_bytes"), limits);
  LowerCpus(ReadNumbers(folder + "/cpu.cfs_quota_us"),
            ReadNumbers(folder + "/cpu.cfs_period_us"), limits);
}

// A group is bound by those around it, too. Within a container the folders of
// the outer ones may be missing, and its own be the top one.
void ApplyGroups(const std::string& top, std::string group,
                 MachineLimits* limits) {
  while (!group.empty() && group != "/") {
    ApplyGroup(top + group, limits);
    group.resize(group.rfind('/'));
  }
  ApplyGroup(top, limits);
}

}  // namespace

MachineLimits FindMachineLimits() {
  MachineLimits limits;
  limits.memory_bytes = 1.0 * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
  limits.num_cpus =
      std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  cpu_set_t bound;
  if (sched_getaffinity(0, sizeof(bound), &bound) == 0) {
    limits.num_cpus = std::clamp(CPU_COUNT(&bound), 1, limits.num_cpus);
  }
  ApplyCgroupLimits("", &limits);
  rlimit space;
  if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY) {
    LowerMemory({static_cast<double>(space.rlim_cur)}, &limits);
  }
  return limits;
}

void ApplyCgroupLimits(const std::string& root, MachineLimits* limits) {
  const std::string top = root + "/sys/fs/cgroup";
  std::ifstream file(root + "/proc/self/cgroup");
  // Such as "0::/group" in version 2, "4:memory:/group" in version 1.
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string number;
    std::string controllers;
    std::string group;
    std::getline(fields, number, ':');
    std::getline(fields, controllers, ':');
    std::getline(fields, group);
    if (group.empty() || group[0] != '/') {
      continue;
    }
    if (controllers.empty()) {
      ApplyGroups(top, group, limits);
    }
    std::istringstream names(controllers);
    for (std::string name; std::getline(names, name, ',');) {
      ApplyGroups(top + "/" + name, group, limits);
    }
  }
}

}  // namespace tapa
