// SPDX-License-Identifier: Apache-2.0
// Seconds of a core's time that the calling thread has had: what others are at meanwhile does not
// count.
#pragma once
#include <ctime>

namespace wellspring {
inline double thread_seconds() {
  timespec had{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &had);
  return double(had.tv_sec) + 1e-9 * double(had.tv_nsec);
}
}  // namespace wellspring
