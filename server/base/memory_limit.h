// SPDX-License-Identifier: Apache-2.0
// How much memory this process may use.
#pragma once
#include <string>

namespace wellspring {

// Bytes: of the machine, or less where a control group bounds it (cgroup v2).
double usable_memory();
// The least bound of the groups that `membership` (as /proc/self/cgroup) names below `root` (as
// /sys/fs/cgroup), from the process's own up to the root; 0: none bounds it.
double memory_bound(const std::string& membership, const std::string& root);

}  // namespace wellspring
