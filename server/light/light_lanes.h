// SPDX-License-Identifier: Apache-2.0
// A pass's point lights side by side, to choose a few of many by what they would do to a place, were
// nothing in between.
#pragma once
#include <span>

#include "base/lanes.h"
#include "light/instant_radiosity.h"

namespace wellspring {

// Eight lights a group, each set's groups for themselves; the last ones of a set are filled up with dark
// lights of number none.
struct LightLanes {
  static constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> number;        // in the pass, of each lane
  std::vector<Lanes> x, y, z;          // position, or direction to it
  std::vector<Lanes> nx, ny, nz;       // normal
  std::vector<Lanes> power;            // of the brightest colour
  std::vector<Lanes> near, back;       // 1 or 0: falls with distance; shines to both sides
  std::vector<Lanes> even;             // 1: alike to all sides; 0: by Lambert
  std::vector<uint32_t> first;         // group of each set, and the end
};

LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass);

// Irradiance at a place by each light of groups [begin, end), nothing in between; returns the sum.
// Nearer than sqrt(clip2) counts as that. What is glossy, place or light, may shine where Lambert would
// not: it is taken for partly even.
float eval_unshadowed(const LightLanes& lights, size_t begin, size_t end, vec3 place, const Bsdf& bsdf,
                      float clip2, Lanes* effect);

// About `asked` of a set's lights, exact ones among them, chosen at random by what they would do to a
// place, weighed so that their mean is the whole set's; at most chosen.size(). Returns how many. u:
// uniform in [0, 1).
int choose_place_lights(const InstantPass& pass, int set, vec3 place, const Bsdf& bsdf, int asked,
                        float u, std::span<RegionLight> chosen);

}  // namespace wellspring
