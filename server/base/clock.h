// SPDX-License-Identifier: Apache-2.0
// Monotonic seconds since the program started; ticks take the time as an argument so tests can set
// it.
#pragma once
#include <chrono>
#include <cstdint>
#include <ctime>

namespace wellspring {
inline double seconds_now() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
// Of a processor, that the calling thread has had so far.
inline double thread_seconds_now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}
// The clock of pictures and sound on the wire: microseconds since 1970.
inline uint64_t microseconds_now() {
  using namespace std::chrono;
  return uint64_t(duration_cast<microseconds>(system_clock::now().time_since_epoch()).count());
}
}  // namespace wellspring
