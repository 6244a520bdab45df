// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/virtual_lights.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/simd.h"
#include "light/random/sampler.h"
#include "light/sample/light_tables.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

// Empties the lights and makes room for twice as many as are wanted in the mean.
void clear_lights(VirtualLights& lights, size_t wanted) {
  const size_t most = (2 * wanted + 64 + lane_count - 1) / lane_count * lane_count;
  if (lights.groups.size() < most / lane_count) lights.groups.resize(most / lane_count);
  if (lights.target.size() < most) lights.target.resize(most);
  lights.count = 0;
}

// Adds a light. `worth`: number of such texels that it stands for.
void add_light(const ReflectiveTexel& texel, double worth, float least2, float bound2,
               VirtualLights& lights) {
  const size_t i = size_t(lights.count);
  if (i >= lights.target.size()) return;
  vec3 intensity = texel.flux * float(worth / double(pi));
  if (!is_finite(intensity) || !(max_component(intensity) > 0)) return;
  float own = std::max(texel.area * float(worth) / pi, least2) * bound2;
  lights.set(i, texel.position, texel.normal, intensity, std::clamp(own, 1e-12f, 1e12f));
  SurfacePlace place;
  place.position = texel.position, place.geometric_normal = texel.normal;
  place.extent = texel.extent;
  lights.target[i] = offset_origin(place, texel.normal);
  lights.count++;
}

double luminous(const ReflectiveTexel& texel) {
  double flux = double(luminance(texel.flux));
  return flux > 0 && std::isfinite(flux) ? flux : 0;
}

}  // namespace

void VirtualLights::set(size_t i, vec3 position, vec3 normal, vec3 intensity, float radius2) {
  Group& group = groups[i / lane_count];
  const int lane = int(i % lane_count);
  group.position.set(lane, position), group.normal.set(lane, normal);
  group.intensity.set(lane, intensity), group.radius2[lane] = radius2;
}

void fill_up(VirtualLights& lights) {
  for (size_t i = size_t(lights.count); i < lights.padded(); i++)
    lights.set(i, vec3(0), {0, 1, 0}, vec3(0), 1);
}

void choose_virtual_lights(const ReflectiveShadowMap& map, const SplatSettings& settings,
                           SplatSeed seed, VirtualLights& lights) {
  constexpr double golden = 0.6180339887498949;
  const int wanted = std::clamp(settings.virtual_lights, 1, most_virtual_lights);
  clear_lights(lights, size_t(wanted));
  float least = settings.least_distance > 0 ? settings.least_distance : 0.02f * map.mean_distance;
  float least2 = std::clamp(least * least, 1e-12f, 1e12f);
  float bound = std::max(settings.bound, 0.0f);
  double sum = 0;
  for (const ReflectiveTexel& texel : map.texels) sum += luminous(texel);
  Sampler sampler(mix64(seed.seed ^ 0x63686f696365ull), seed.pass);
  double number = double(sampler.next());
  for (size_t i = 0; sum > 0 && i < map.texels.size(); i++) {
    number += golden;
    number -= number >= 1 ? 1 : 0;
    const double often = luminous(map.texels[i]) * wanted / sum;
    const double times = std::floor(often + number);
    if (times > 0) add_light(map.texels[i], times / often, least2, bound * bound, lights);
  }
  fill_up(lights);
}

namespace {

// Share of the choice that does not depend on the effect: for gloss, and what the estimate leaves
// out.
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
  all.groups[g].position.set(int(lane), place);
  all.groups[g].normal.set(int(lane), light.normal);
  all.power[g][lane] = max_component(color);
  all.near[g][lane] = near, all.even[g][lane] = even, all.back[g][lane] = light.double_sided;
}

// Fills up the group that is open.
void end_group(LightLanes& all) {
  while (all.number.size() % lane_count) all.number.push_back(LightLanes::none);
}

// Sets the lanes of the lights that all.number names.
void set_lanes(const LightTables& tables, const InstantPass& pass, LightLanes& all) {
  size_t groups = all.number.size() / lane_count;
  all.groups.assign(groups, {});
  for (std::vector<Lanes>* lanes : {&all.power, &all.near, &all.even, &all.back})
    lanes->assign(groups, all_lanes(0));
  all.plain.assign(groups, 1);
  parallel_ranges(int(groups), 64, [&](int first, int last) {
    for (size_t i = size_t(first) * lane_count; i < size_t(last) * lane_count; i++) {
      if (all.number[i] == LightLanes::none) continue;
      size_t g = i / lane_count, lane = i % lane_count;
      set_lane(tables, pass.lights[all.number[i]], g, lane, all);
      bool plain = all.near[g][lane] == 1 && all.back[g][lane] == 0 && all.even[g][lane] == 0;
      if (!plain) all.plain[g] = 0;
    }
  });
}

}  // namespace

LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass) {
  LightLanes all;
  for (int set = 0; set < pass.sets(); set++) {
    all.first.push_back(uint32_t(all.number.size() / lane_count));
    for (uint32_t k = pass.first[size_t(set)]; k < pass.first[size_t(set) + 1]; k++)
      all.number.push_back(k);
    end_group(all);
  }
  all.first.push_back(uint32_t(all.number.size() / lane_count));
  set_lanes(tables, pass, all);
  return all;
}

LightLanes make_light_lanes(const LightTables& tables, const InstantPass& pass,
                            std::span<const uint32_t> lights) {
  LightLanes all;
  all.number.assign(lights.begin(), lights.end());
  end_group(all);
  all.first = {0, uint32_t(all.number.size() / lane_count)};
  set_lanes(tables, pass, all);
  return all;
}

LitPoint make_lit_point(vec3 position, const Bsdf& bsdf) {
  return {position, bsdf.normal, max_component(bsdf.transmit) > 0,
          has_specular(bsdf) ? glossy_even : 0};
}

int choose_place_lights(const InstantPass& pass, int set, vec3 place, const Bsdf& bsdf, int asked,
                        float u, std::span<RegionLight> chosen) {
  // Only groups far from each other are asked of a large set: an estimate of all costs more than
  // the rays it saves.
  constexpr size_t most_groups = 12;
  if (asked < 1 || !pass.lanes) return 0;
  const LightLanes& all = *pass.lanes;
  const size_t begin = all.first[size_t(set)], end = all.first[size_t(set) + 1];
  const size_t step = std::max<size_t>(1, (end - begin + most_groups - 1) / most_groups);
  const size_t start = std::min(size_t(u * float(step)), step - 1);
  u = u * float(step) - float(start);
  const LitPoint point = make_lit_point(place, bsdf);
  const float most = most_of_clip(pass.clip);
  Lanes effect[most_groups + 1], total{};
  int count = 0;
  float number = 0;
  for (size_t g = begin + start; g < end; g += step) {
    Lanes& e = effect[(g - begin) / step];
    e = eval_unshadowed(all, g, point, most);
    total += e;
    for (int lane = 0; lane < lane_count; lane++)
      number += all.number[g * lane_count + size_t(lane)] != LightLanes::none;
  }
  float sum_of_all = lanes_sum(total);
  bool known = sum_of_all > 0 && std::isfinite(sum_of_all);
  float uniform = float(asked) * (known ? blind : 1) / std::max(number, 1.0f),
        scale = known ? float(asked) * (1 - blind) / sum_of_all : 0;
  float sum = -u;
  for (size_t g = begin + start; g < end; g += step)
    for (int lane = 0; lane < lane_count; lane++) {
      uint32_t light = all.number[g * lane_count + size_t(lane)];
      if (light == LightLanes::none) continue;
      float often = uniform + (known ? scale * effect[(g - begin) / step][lane] : 0);
      sum += often;
      if (sum <= 0) continue;
      float times = std::ceil(sum);
      sum -= times;
      if (count < int(chosen.size()))
        chosen[size_t(count++)] = {light, float(step) * times / often};
    }
  return count;
}

}  // namespace wellspring::light
