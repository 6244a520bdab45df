// SPDX-License-Identifier: Apache-2.0
// What the light's own points say of eight pixels of a picture, as picture/surface_image.h packs
// them.
#pragma once
#include <algorithm>

#include "picture/drawn_planes.h"

namespace wellspring {

template <int Scale>
constexpr Lanes light_columns =
    Scale == 1 ? Lanes{0, 1, 2, 3, 4, 5, 6, 7} : Lanes{0, 0, 1, 1, 2, 2, 3, 3};

// What the light's points say of eight pixels.
struct OwnLight {
  LaneBits plane[surface_planes];
};
// Of `count` light pixels, not all of them in the picture.
[[gnu::noinline]] inline void read_cut(const Frame& light, int lx, int ly, int count,
                                       uint32_t (*words)[lane_count]) {
  for (int p = 0; p < surface_planes; p++)
    std::fill_n(words[p], lane_count, p == plane_object ? no_object : 0);
  for (int x = std::max(lx, 0); x < std::min(lx + count, light.width); x++) {
    uint32_t word[surface_planes];
    read_packed(light, x, ly, word);
    for (int p = 0; p < surface_planes; p++) words[p][x - lx] = word[p];
  }
}
// Each light pixel is for `Scale` pixels of a row.
template <int Scale>
OwnLight read_own(const Frame& light, int lx, int ly) {
  constexpr int count = lane_count / Scale;
  auto spread = [](const uint32_t* from) {
    if constexpr (Scale == 1) return load_lanes<LaneBits>(from);
    HalfLaneBits v = load_lanes<HalfLaneBits>(from);
    return __builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3);
  };
  OwnLight own;
  if (lx < 0 || lx + count > light.width) {
    uint32_t words[surface_planes][lane_count];
    read_cut(light, lx, ly, count, words);
    for (int p = 0; p < surface_planes; p++) own.plane[p] = spread(words[p]);
    return own;
  }
  size_t at = size_t(ly) * size_t(light.width) + size_t(lx);
  auto bits = [&](const std::vector<float>& plane) {
    return reinterpret_cast<const uint32_t*>(&plane[at]);
  };
  own.plane[plane_object] = spread(&light.object[at]);
  own.plane[plane_more] = spread(bits(light.confidence));
  own.plane[plane_depth] = spread(bits(light.depth));
  const uint32_t* words = packed_words(light, lx, ly);
  for (int p : {plane_albedo, plane_rest, plane_smooth}) {
    const uint32_t* four = words + packed_four * p;
    if constexpr (Scale == 1)
      own.plane[p] = join_halves(load_lanes<HalfLaneBits>(four),
                                 load_lanes<HalfLaneBits>(four + 3 * packed_four));
    else own.plane[p] = spread(four);
  }
  return own;
}

}  // namespace wellspring
