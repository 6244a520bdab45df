// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace wellspring {

double memory_bound(const std::string& membership, const std::string& root) {
  double least = 0;
  std::istringstream lines(membership);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("0::/")) continue;  // other lines are of cgroup v1
    for (std::filesystem::path group = line.substr(3);; group = group.parent_path()) {
      std::ifstream file(root + group.string() + "/memory.max");
      double bytes = 0;  // "max" is no number
      if (file >> bytes && bytes > 0) least = least > 0 ? std::min(least, bytes) : bytes;
      if (group == group.parent_path()) break;
    }
  }
  return least;
}

double usable_memory() {
  const double machine = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
  std::ifstream file("/proc/self/cgroup");
  std::ostringstream membership;
  membership << file.rdbuf();
  const double bound = memory_bound(membership.str(), "/sys/fs/cgroup");
  return bound > 0 ? std::min(machine, bound) : machine;
}

}  // namespace wellspring
