// SPDX-License-Identifier: Apache-2.0
// Pixels of a frame from lanes, and back.
#pragma once
#include <cstring>

#include "base/simd.h"
#include "frame/frame.h"

namespace wellspring::frame {

// Four pixels' channels one after the other.
inline void interleave(const HalfLanes& r, const HalfLanes& g, const HalfLanes& b, float* to) {
  HalfLanes low = __builtin_shufflevector(r, g, 0, 4, 1, 5),
            high = __builtin_shufflevector(r, g, 2, 6, 3, 7),
            middle = __builtin_shufflevector(low, b, 3, 5, 3, 5);
  store_lanes(to, __builtin_shufflevector(low, b, 0, 1, 4, 2));
  store_lanes(to + 4, __builtin_shufflevector(middle, high, 0, 1, 4, 5));
  store_lanes(to + 8, __builtin_shufflevector(high, b, 6, 2, 3, 7));
}
template <int First>
HalfLanes part(const Lanes& v) {
  return __builtin_shufflevector(v, v, First, First + 1, First + 2, First + 3);
}

}  // namespace wellspring::frame
