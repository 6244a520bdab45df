// SPDX-License-Identifier: Apache-2.0
// Holds a pass's point lights side by side, to choose a few of many by what they would do to a
// place if nothing were in between.
#pragma once
#include <algorithm>
#include <span>

#include "base/simd.h"
#include "light/virtual/instant_pass.h"

namespace wellspring::light {

// Holds lights in groups of eight, those of each set in groups of their own; a set's last group is
// filled up with dark lights of number none.
struct LightLanes {
  static constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> number;   // number in the pass, for each lane
  std::vector<Lanes> x, y, z;     // position, or direction to the light
  std::vector<Lanes> nx, ny, nz;  // normal
  std::vector<Lanes> power;       // power of the brightest colour
  std::vector<Lanes> near, back;  // 1 or 0: weaker with distance; emits light to both sides
  std::vector<Lanes> even;        // 1: alike to all sides; 0: by Lambert
  std::vector<uint8_t> plain;     // for each group: all are near, by Lambert, to one side
  std::vector<uint32_t> first;    // first group of each set, and the end
};

LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass);
// Makes lanes of these lights, in this order, as one set.
LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass,
                            std::span<const uint32_t> lights);

// Holds a place as the estimate sees it. A glossy place or light may send light where Lambert's law
// would not: it counts as partly even.
struct LitPoint {
  vec3 position{0}, normal{0, 1, 0};
  bool both_sides = false;
  float even = 0;
};
LitPoint make_lit_point(vec3 position, const Bsdf& bsdf);

// Returns the irradiance at a point by the lights of a group, nothing in between; `most`: greatest
// value of 1 over squared distance.
inline Lanes eval_unshadowed(const LightLanes& all, size_t g, const LitPoint& point, float most) {
  const Lanes zero{}, one = all_lanes(1.0f);
  if (all.plain[g] && !point.both_sides && point.even == 0) {  // the same without roots
    Lanes x = all.x[g] - point.position.x, y = all.y[g] - point.position.y,
          z = all.z[g] - point.position.z;
    Lanes inverse2 = one / lanes_max(x * x + y * y + z * z, all_lanes(1e-20f));
    Lanes here = x * point.normal.x + y * point.normal.y + z * point.normal.z;
    Lanes there = -(x * all.nx[g] + y * all.ny[g] + z * all.nz[g]);
    return all.power[g] * lanes_max(here, zero) * lanes_max(there, zero) * inverse2 *
           lanes_min(inverse2, all_lanes(most));
  }
  Lanes dx = all.x[g] - point.position.x * all.near[g],
        dy = all.y[g] - point.position.y * all.near[g],
        dz = all.z[g] - point.position.z * all.near[g];
  Lanes inverse = one / lanes_sqrt(lanes_max(dx * dx + dy * dy + dz * dz, all_lanes(1e-20f)));
  Lanes here = (dx * point.normal.x + dy * point.normal.y + dz * point.normal.z) * inverse;
  Lanes there = -(dx * all.nx[g] + dy * all.ny[g] + dz * all.nz[g]) * inverse;
  here = point.both_sides ? lanes_abs(here) : lanes_max(here, zero);
  there = all.back[g] > 0 ? lanes_abs(there) : lanes_max(there, zero);
  here += point.even * (one - here);
  there += all.even[g] * (one - there);
  Lanes falls = all.near[g] > 0 ? lanes_min(inverse * inverse, all_lanes(most)) : one;
  return all.power[g] * here * there * falls;
}
inline float most_of_clip(float clip) { return 1 / std::max(clip * clip, 1e-12f); }

// Chooses about `asked` of a set's lights, exact ones among them, at random by what they would do
// to a place, weighed so that their mean is the whole set's; at most chosen.size(). Returns how
// many. u: uniform in [0, 1).
int choose_place_lights(const InstantPass& pass, int set, vec3 place, const Bsdf& bsdf, int asked,
                        float u, std::span<RegionLight> chosen);

}  // namespace wellspring::light
