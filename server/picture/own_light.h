// SPDX-License-Identifier: Apache-2.0
// What the light's own points say of eight pixels of a picture, as picture/surface_image.h packs
// them.
#pragma once
#include <algorithm>

#include "picture/drawn_planes.h"

namespace wellspring::picture {

struct OwnLight {
  LaneBits plane[surface_planes];
};
// Reads eight pixels, not all of which are in the picture.
[[gnu::noinline]] inline void read_cut(const Frame& light, int lx, int ly,
                                       uint32_t (*words)[lane_count]) {
  for (int p = 0; p < surface_planes; p++)
    std::fill_n(words[p], lane_count, p == plane_object ? no_object : 0);
  for (int x = std::max(lx, 0); x < std::min(lx + lane_count, light.width); x++) {
    uint32_t word[surface_planes];
    read_packed(light, x, ly, word);
    for (int p = 0; p < surface_planes; p++) words[p][x - lx] = word[p];
  }
}
inline OwnLight read_own(const Frame& light, int lx, int ly) {
  OwnLight own;
  if (lx < 0 || lx + lane_count > light.width) {
    uint32_t words[surface_planes][lane_count];
    read_cut(light, lx, ly, words);
    for (int p = 0; p < surface_planes; p++) own.plane[p] = load_lanes<LaneBits>(words[p]);
    return own;
  }
  size_t at = size_t(ly) * size_t(light.width) + size_t(lx);
  auto bits = [&](const std::vector<float>& plane) {
    return reinterpret_cast<const uint32_t*>(&plane[at]);
  };
  own.plane[plane_object] = load_lanes<LaneBits>(&light.object[at]);
  own.plane[plane_more] = load_lanes<LaneBits>(bits(light.confidence));
  own.plane[plane_depth] = load_lanes<LaneBits>(bits(light.depth));
  const uint32_t* words = packed_words(light, lx, ly);
  for (int p : {plane_albedo, plane_rest, plane_smooth}) {
    const uint32_t* four = words + packed_four * p;
    own.plane[p] = join_halves(load_lanes<HalfLaneBits>(four),
                               load_lanes<HalfLaneBits>(four + 3 * packed_four));
  }
  return own;
}

}  // namespace wellspring::picture
