// SPDX-License-Identifier: Apache-2.0
// How much memory this process may use, and giving back what it does not.
#pragma once
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace wellspring {

// Bytes: of the machine, or less where a control group bounds it (cgroup v2).
double usable_memory();
// The least bound of the groups that `membership` (as /proc/self/cgroup) names below `root` (as
// /sys/fs/cgroup), from the process's own up to the root; 0: none bounds it.
double memory_bound(const std::string& membership, const std::string& root);

// Gives freed memory back to the system. glibc keeps it for the next who asks, in an arena for each
// of many threads: after a crowd has left that is hundreds of MiB. Takes milliseconds, in which
// other threads wait for memory; does nothing where there is no glibc.
inline void return_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace wellspring
