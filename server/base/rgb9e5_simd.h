// SPDX-License-Identifier: Apache-2.0
// unpack_rgb9e5() of base/rgb9e5.h, of eight at a time.
#pragma once
#include "base/simd.h"

namespace wellspring {

inline void unpack_rgb9e5(const LaneBits& p, Lanes& r, Lanes& g, Lanes& b) {
  Lanes unit = lanes_as<Lanes>(((p >> 27) + (127 - 24)) << 23);
  r = to_float(p & 511u) * unit;
  g = to_float((p >> 9) & 511u) * unit;
  b = to_float((p >> 18) & 511u) * unit;
}

}  // namespace wellspring
