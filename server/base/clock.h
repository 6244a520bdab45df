// SPDX-License-Identifier: Apache-2.0
// Clocks: of the day, since the start, and of processors. Ticks take the time as an argument, so
// that tests can set it.
#pragma once
#include <chrono>
#include <cstdint>
#include <ctime>

#include "base/layers.h"

namespace wellspring {

// Returns monotonic seconds since the program started.
inline double seconds_now() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns microseconds since 1970, by which pictures and sound are dated on the wire.
inline uint64_t microseconds_now() {
  using namespace std::chrono;
  return uint64_t(duration_cast<microseconds>(system_clock::now().time_since_epoch()).count());
}

inline double seconds_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

// Returns the seconds of a processor that the calling thread has had so far.
inline double thread_seconds_now() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

// Returns the core-seconds that all threads of this process have had so far. It tells what a loop
// over cores costs: each of its threads has a clock of its own, and oneTBB says which take part.
// What the process does beside is counted, too; what other programs do is not, so that on a busy
// machine the cost stays what it was.
inline double process_seconds_now() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

}  // namespace wellspring
