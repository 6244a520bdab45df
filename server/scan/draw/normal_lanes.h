// SPDX-License-Identifier: Apache-2.0
// Unpacks octahedral normals of points (NodePoints::normal), eight at a time.
#pragma once
#include "base/simd.h"
#include "scan/tree/octahedral.h"

namespace wellspring::scan {

inline constexpr int no_point_normal = no_normal;

// Holds places on the unfolded octahedron, -1 to 1.
struct UnfoldedNormals {
  Lanes u, v;
};
inline UnfoldedNormals unpack_normals(const LaneMask& words) {
  return {__builtin_convertvector((words << 24) >> 24, Lanes) * (1 / 127.0f),
          __builtin_convertvector((words << 16) >> 24, Lanes) * (1 / 127.0f)};
}
// Returns the directions, |x| + |y| + |z| is 1.
inline Lanes3 fold_normals(const UnfoldedNormals& n) {
  const Lanes w = 1 - lanes_abs(n.u) - lanes_abs(n.v), fold = positive_lanes(-w);
  return {n.u + (n.u < 0 ? fold : -fold), n.v + (n.v < 0 ? fold : -fold), w};
}

}  // namespace wellspring::scan
