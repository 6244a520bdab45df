// SPDX-License-Identifier: Apache-2.0
// Eight vectors of three side by side.
#pragma once
#include "base/simd.h"
#include "base/vec.h"

namespace wellspring {

struct Lanes3 {
  Lanes x{}, y{}, z{};
  vec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, vec3 v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};
inline Lanes3 all_lanes(vec3 v) { return {all_lanes(v.x), all_lanes(v.y), all_lanes(v.z)}; }
inline Lanes3 operator+(Lanes3 a, Lanes3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Lanes3 operator-(Lanes3 a, Lanes3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Lanes3 operator-(Lanes3 a) { return {-a.x, -a.y, -a.z}; }
inline Lanes3 operator*(Lanes3 a, Lanes3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Lanes3 operator*(Lanes3 a, Lanes b) { return {a.x * b, a.y * b, a.z * b}; }
inline Lanes dot(Lanes3 a, Lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes max_component(Lanes3 a) { return lanes_max(a.x, lanes_max(a.y, a.z)); }
inline Lanes3 choose(LaneMask mask, Lanes3 a, Lanes3 b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace wellspring
