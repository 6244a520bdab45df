// SPDX-License-Identifier: Apache-2.0
// Chooses virtual point lights (VPLs; Keller 1997) among the texels of reflective shadow maps. Each
// counts the more the less likely it was to be chosen, so that in the mean they are all of the
// maps.
//
// A VPL stands for the surface around it. Its light at a distance d is that of a disc of
// radius r which is as large as that surface, seen along its axis: intensity / (d^2 + r^2) instead
// of / d^2, the limit of many small ones. So a VPL never adds more than its surface
// itself would, and no pixel is far too bright where one lies in a corner.
#pragma once
#include <algorithm>
#include <span>

#include "base/memory.h"
#include "base/simd.h"
#include "light/virtual/instant_pass.h"
#include "light/virtual/reflective_shadow_map.h"

namespace wellspring::light {

// Holds eight VPLs side by side, as vector units want them, whoever has drawn them.
struct VplGroup {
  Lanes3 position;  // scene coordinates, or direction to a light from infinity
  Lanes3 normal;    // unit: light leaves on its side, by the cosine
};

// Holds VPLs of reflective shadow maps, filled up with lights of no intensity to whole groups.
struct VirtualLights {
  struct Group : VplGroup {
    Lanes3 intensity;  // along the normal, W/sr
    Lanes radius2;     // square metres; above 0
  };
  int count = 0;            // without the lights that fill up
  RawVector<Group> groups;  // at least padded() lights
  RawVector<vec3> target;   // end of shadow rays, clear of the surface; one for each of `count`
  size_t padded() const { return (size_t(count) + lane_count - 1) / lane_count * lane_count; }
  vec3 position(size_t i) const { return groups[i / lane_count].position.at(i % lane_count); }
  vec3 normal(size_t i) const { return groups[i / lane_count].normal.at(i % lane_count); }
  vec3 intensity(size_t i) const { return groups[i / lane_count].intensity.at(i % lane_count); }
  float radius2(size_t i) const { return groups[i / lane_count].radius2[i % lane_count]; }
  void set(size_t i, vec3 position, vec3 normal, vec3 intensity, float radius2);
};

// Fills up to padded() lights.
void fill_up(VirtualLights& lights);

// Chooses about settings.virtual_lights texels by their flux, fewer if few have any. Each has a
// number of its own, which is the golden ratio's sequence along the list: neighbours in the list
// are neighbours in a map, so that the chosen ones are spread everywhere, and a flux that changes
// changes few other choices. One map and seed always give the same choice.
void choose_virtual_lights(const ReflectiveShadowMap& map, const SplatSettings& settings,
                           SplatSeed seed, VirtualLights& lights);

// Holds a pass's VPLs side by side, to choose a few of many by what they would do to a
// place if nothing were in between.

// Holds lights in groups of eight, those of each set in groups of their own; a set's last group is
// filled up with dark lights of number none.
struct LightLanes {
  static constexpr uint32_t none = 0xffffffffu;
  std::vector<uint32_t> number;  // number in the pass, for each lane
  std::vector<VplGroup> groups;
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
  const VplGroup& vpls = all.groups[g];
  const Lanes3 position = all_lanes(point.position), normal = all_lanes(point.normal);
  if (all.plain[g] && !point.both_sides && point.even == 0) {  // the same without roots
    const Lanes3 way = vpls.position - position;
    Lanes inverse2 = one / lanes_max(dot(way, way), all_lanes(1e-20f));
    Lanes here = dot(way, normal), there = -dot(way, vpls.normal);
    return all.power[g] * lanes_max(here, zero) * lanes_max(there, zero) * inverse2 *
           lanes_min(inverse2, all_lanes(most));
  }
  const Lanes3 way = vpls.position - position * all.near[g];
  Lanes inverse = one / lanes_sqrt(lanes_max(dot(way, way), all_lanes(1e-20f)));
  Lanes here = dot(way, normal) * inverse, there = -dot(way, vpls.normal) * inverse;
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
