// SPDX-License-Identifier: Apache-2.0
// Monotonic seconds since the program started; ticks take the time as an argument so tests can set it.
#pragma once
#include <chrono>

namespace wellspring {
inline double seconds_now() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}
}  // namespace wellspring
