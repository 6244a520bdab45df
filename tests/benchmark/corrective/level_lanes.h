// SPDX-License-Identifier: Apache-2.0
// Samples of a list, eight at a time; the last of a list may be fewer.
#pragma once
#include "base/simd.h"

namespace wellspring::test {

// The first `count` of eight neighbours in memory, 0 in the other lanes.
template <class V = Lanes, class T>
inline V load_some(const T* from, int count) {
  if (count >= lane_count) return load_lanes<V>(from);
  V v{};
  std::memcpy(&v, from, size_t(count) * sizeof(T));
  return v;
}
// Loads places from a list that has arrays x, y and z.
template <class Samples>
inline Lanes3 load_places(const Samples& list, int begin, int count) {
  size_t i = size_t(begin);
  return {load_some(&list.x[i], count), load_some(&list.y[i], count), load_some(&list.z[i], count)};
}

}  // namespace wellspring::test
