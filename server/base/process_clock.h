// SPDX-License-Identifier: Apache-2.0
// Processor time of the whole process. What a loop over cores costs: each of its threads has a
// clock of its own, and which threads take part is oneTBB's to say. What the process does beside
// it is counted, too, so the cost is never too low; what other programs do is not, so on a busy
// machine it stays what it was.
#pragma once
#include <ctime>

namespace wellspring {

// Core-seconds that all threads of this process have had so far.
inline double process_seconds_now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

}  // namespace wellspring
