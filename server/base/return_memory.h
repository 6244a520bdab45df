// SPDX-License-Identifier: Apache-2.0
// Memory that was freed goes back to the system. glibc keeps it for the next who asks, in an arena
// for each of many threads: after a crowd has left that is hundreds of MiB. Takes milliseconds, in
// which other threads wait for memory; nothing where there is no glibc.
#pragma once

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace wellspring {

inline void return_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace wellspring
