// SPDX-License-Identifier: Apache-2.0
#include "light/light_lanes.h"

#include <algorithm>
#include <cmath>

#include "light/light_tables.h"

namespace wellspring {
namespace {

// Share of the choice that asks for no effect: gloss, and what the estimate leaves out.
constexpr float blind = 0.15f;
constexpr float glossy_even = 0.25f;

void set_lane(const LightTables& tables, const PointLight& light, size_t g, size_t lane,
              LightLanes& all) {
  vec3 place = light.position, color = light.radiance;
  bool near = light.kind != PointLightKind::distant;
  float even = near ? 0 : 1;
  if (light.kind == PointLightKind::scattering) color /= pi, even = glossy_even;
  if (light.kind == PointLightKind::punctual) {
    const PunctualLight& punctual = tables.punctual[light.index];
    color *= punctual.intensity;
    near = punctual.type != PunctualType::directional;
    place = near ? punctual.position : -punctual.direction;
    even = 1;
  }
  all.x[g][lane] = place.x, all.y[g][lane] = place.y, all.z[g][lane] = place.z;
  all.nx[g][lane] = light.normal.x, all.ny[g][lane] = light.normal.y;
  all.nz[g][lane] = light.normal.z;
  all.power[g][lane] = max_component(color);
  all.near[g][lane] = near, all.even[g][lane] = even, all.back[g][lane] = light.double_sided;
}

}  // namespace

LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass) {
  LightLanes all;
  for (int set = 0; set < pass.sets(); set++) {
    all.first.push_back(uint32_t(all.number.size() / lane_count));
    for (uint32_t k = pass.first[size_t(set)]; k < pass.first[size_t(set) + 1]; k++)
      all.number.push_back(k);
    while (all.number.size() % lane_count) all.number.push_back(LightLanes::none);
  }
  size_t groups = all.number.size() / lane_count;
  all.first.push_back(uint32_t(groups));
  for (std::vector<Lanes>* lanes : {&all.x, &all.y, &all.z, &all.nx, &all.ny, &all.nz, &all.power,
                                    &all.near, &all.even, &all.back})
    lanes->assign(groups, all_lanes(0));
  for (size_t i = 0; i < all.number.size(); i++)
    if (all.number[i] != LightLanes::none)
      set_lane(tables, pass.lights[all.number[i]], i / lane_count, i % lane_count, all);
  return all;
}

float eval_unshadowed(const LightLanes& all, size_t begin, size_t end, vec3 place, const Bsdf& bsdf,
                      float clip2, Lanes* effect) {
  vec3 normal = bsdf.normal;
  bool both_sides = max_component(bsdf.transmit) > 0;
  float even = has_specular(bsdf) ? glossy_even : 0;
  Lanes total = all_lanes(0), zero = all_lanes(0), one = all_lanes(1);
  Lanes least = all_lanes(std::max(clip2, 1e-12f));
  for (size_t g = begin; g < end; g++) {
    Lanes dx = all.x[g] - place.x * all.near[g], dy = all.y[g] - place.y * all.near[g],
          dz = all.z[g] - place.z * all.near[g];
    Lanes d2 = lanes_max(dx * dx + dy * dy + dz * dz, all_lanes(1e-20f));
    Lanes inverse = one / lanes_sqrt(d2);
    Lanes here = (dx * normal.x + dy * normal.y + dz * normal.z) * inverse;
    Lanes there = -(dx * all.nx[g] + dy * all.ny[g] + dz * all.nz[g]) * inverse;
    here = both_sides ? lanes_abs(here) : lanes_max(here, zero);
    there = all.back[g] > 0 ? lanes_abs(there) : lanes_max(there, zero);
    here += even * (one - here);
    there += all.even[g] * (one - there);
    Lanes falls = all.near[g] > 0 ? one / lanes_max(d2, least) : one;
    Lanes here_and_there = all.power[g] * here * there * falls;
    effect[g - begin] = here_and_there;
    total += here_and_there;
  }
  return lanes_sum(total);
}

int choose_place_lights(const InstantPass& pass, int set, vec3 place, const Bsdf& bsdf, int asked,
                        float u, std::span<RegionLight> chosen) {
  uint32_t number = pass.first[size_t(set) + 1] - pass.first[size_t(set)];
  if (number == 0 || asked < 1 || !pass.lanes) return 0;
  const LightLanes& all = *pass.lanes;
  size_t begin = all.first[size_t(set)], end = all.first[size_t(set) + 1];
  std::vector<Lanes> effect(end - begin);
  float total = eval_unshadowed(all, begin, end, place, bsdf, pass.clip * pass.clip, effect.data());
  bool known = total > 0 && std::isfinite(total);
  float uniform = float(asked) * (known ? blind : 1) / float(number),
        scale = known ? float(asked) * (1 - blind) / total : 0;
  float sum = -u;
  int count = 0;
  for (uint32_t k = 0; k < number; k++) {
    float often = uniform + (known ? scale * effect[k / lane_count][k % lane_count] : 0);
    sum += often;
    if (sum <= 0) continue;
    float times = std::ceil(sum);
    sum -= times;
    if (count < int(chosen.size()))
      chosen[size_t(count++)] = {all.number[begin * lane_count + k], times / often};
  }
  return count;
}

}  // namespace wellspring
