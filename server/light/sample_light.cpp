// SPDX-License-Identifier: Apache-2.0
#include "light/sample_light.h"

#include <algorithm>
#include <cmath>

#include "light/warp.h"

namespace wellspring {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

LightSample sample_emitter(const Transport& transport, const Surface& from, Sampler& sampler) {
  const LightTables& tables = transport.tables;
  vec2 u = sampler.next2();
  EmitterPick pick = sample_group(tables.emitter_choice, from.position, from.geometric_normal, u.x);
  if (!(pick.probability > 0)) return {};
  const EmitterTriangle& e = tables.emitters[pick.index];
  vec2 b = sample_triangle({pick.u, u.y});
  Surface place;
  place.position = e.corner + b.x * e.edge1 + b.y * e.edge2;
  place.geometric_normal = e.normal;
  place.extent = e.extent;
  vec3 line = place.position - from.position;
  float distance2 = dot(line, line);
  LightSample light;
  if (!(distance2 > 0) || !(e.area > 0)) return light;
  light.distance = std::sqrt(distance2);
  light.direction = line / light.distance;
  float cosine = -dot(light.direction, e.normal);
  if (cosine <= 0) {
    if (!e.double_sided) return light;
    cosine = -cosine;
  }
  if (cosine < 1e-7f) return light;
  light.radiance = e.emission;
  if (!e.uniform) {
    Ray ray;
    ray.origin = from.position;
    ray.direction = light.direction;
    Hit hit;
    hit.t = light.distance;
    hit.instance = e.instance;
    hit.triangle = e.triangle;
    hit.barycentric = b;
    Surface shown = eval_surface(transport.world, ray, hit);
    const Material& material = transport.world.material_of(e.instance);
    float cover = 1;
    if (material.alpha_mode == AlphaMode::mask) cover = shown.alpha < material.alpha_cutoff ? 0 : 1;
    if (material.alpha_mode == AlphaMode::blend) cover = shown.alpha;
    light.radiance = surface_emission(shown, material) * cover;
  }
  light.target = offset_origin(place, -light.direction);
  light.pdf = tables.emitter_share * pick.probability * distance2 / (cosine * e.area);
  return light;
}

// glTF KHR_lights_punctual: inverse square, range window, cone.
LightSample eval_punctual(const PunctualLight& punctual, const SpotCone& spot,
                          const Surface& from) {
  LightSample light;
  if (punctual.type == PunctualType::directional) {
    light.direction = -punctual.direction;
    light.radiance = punctual.intensity;
    light.pdf = 1;
    return light;
  }
  vec3 line = punctual.position - from.position;
  float distance2 = dot(line, line);
  if (!(distance2 > 1e-20f) || !std::isfinite(distance2)) return light;
  light.distance = std::sqrt(distance2);
  light.direction = line / light.distance;
  light.target = punctual.position;
  float strength = 1 / distance2;
  if (std::isfinite(punctual.range) && punctual.range > 0) {
    float ratio = light.distance / punctual.range, r2 = ratio * ratio;
    strength *= glm::clamp(1 - r2 * r2, 0.0f, 1.0f);
  }
  if (punctual.type == PunctualType::spot) {
    float cosine = -dot(light.direction, punctual.direction);
    float t = glm::clamp((cosine - spot.outer) * spot.scale, 0.0f, 1.0f);
    strength *= t * t;
  }
  light.radiance = punctual.intensity * strength;
  light.pdf = strength > 0 ? 1.0f : 0.0f;
  return light;
}

}  // namespace

LightSample sample_area_light(const Transport& transport, const Surface& from, Sampler& sampler) {
  const LightTables& tables = transport.tables;
  bool emitters = !tables.emitter_choice.empty(),
       sky = !tables.environment.cells.cells.empty();
  if (!emitters && !sky) return {};
  if (emitters && (!sky || sampler.next() < tables.emitter_share))
    return sample_emitter(transport, from, sampler);
  EnvironmentSample s = sample_environment(tables.environment, sampler);
  LightSample light;
  light.direction = s.direction;
  light.radiance = eval_environment(tables.environment, s.direction);
  light.pdf = (1 - tables.emitter_share) * s.pdf;
  return light;
}

float sample_emitter_pdf(const LightTables& tables, vec3 from, vec3 normal, vec3 direction,
                         const Surface& met) {
  uint32_t first = tables.first_emitter[met.instance];
  if (first == no_emitter || tables.emitter_choice.empty()) return 0;
  const EmitterTriangle& e = tables.emitters[first + met.triangle];
  float cosine = std::abs(dot(direction, e.normal));
  if (!(e.area > 0) || cosine < 1e-7f) return 0;
  vec3 line = met.position - from;
  return tables.emitter_share *
         sample_group_probability(tables.emitter_choice, from, normal, first + met.triangle) *
         dot(line, line) / (cosine * e.area);
}

float sample_sky_pdf(const LightTables& tables, vec3 direction) {
  return (1 - tables.emitter_share) * sample_environment_pdf(tables.environment, direction);
}

LightSample sample_punctual_light(const Transport& transport, const Surface& from, vec3 normal,
                                  bool through, Sampler& sampler) {
  const std::vector<PunctualLight>& lights = transport.tables.punctual;
  constexpr size_t most = 16;
  // More lights than candidates: every n-th from a random start, each with the same chance.
  size_t count = lights.size(), taken = std::min(count, most);
  float step = float(count) / float(taken);
  float start = count > most ? sampler.next() : 0;
  // Two draws, near lights and distant ones, and then one of the two: the sun outshines every lamp
  // wherever it would shine, and indoors it rarely does, so it may not crowd the lamps out.
  LightSample drawn[2];
  float drawn_effect[2] = {0, 0}, sum[2] = {0, 0};
  for (size_t i = 0; i < taken; i++) {
    size_t index = count > most ? std::min(size_t((float(i) + start) * step), count - 1) : i;
    LightSample light = eval_punctual(lights[index], transport.tables.cones[index], from);
    if (light.pdf <= 0) continue;
    float cosine = dot(light.direction, normal);
    if (cosine <= 0 && !through) continue;
    // The floor keeps a chance for glossy lobes at grazing angles.
    float effect = luminance(light.radiance) * (std::abs(cosine) + 0.05f);
    if (!(effect > 0) || !std::isfinite(effect)) continue;
    int group = lights[index].type == PunctualType::directional;
    sum[group] += effect;
    if (sampler.next() * sum[group] < effect) {
      drawn[group] = light;
      drawn_effect[group] = effect;
    }
  }
  if (!(sum[0] + sum[1] > 0)) return {};
  float chance = 0.15f + 0.7f * sum[1] / (sum[0] + sum[1]);  // of the distant one
  if (sum[0] == 0) chance = 1;
  if (sum[1] == 0) chance = 0;
  int group = sampler.next() < chance;
  LightSample chosen = drawn[group];
  chosen.radiance *= step * sum[group] / (drawn_effect[group] * (group ? chance : 1 - chance));
  return chosen;
}

vec3 eval_visibility(const Transport& transport, const Surface& from, const LightSample& light) {
  Ray ray;
  ray.origin = offset_origin(from, light.direction);
  ray.direction = light.direction;
  bool finite = std::isfinite(light.distance);
  auto aim = [&] {
    if (!finite) return true;
    vec3 line = light.target - ray.origin;
    ray.t_max = length(line);
    if (!(ray.t_max > 0) || dot(line, light.direction) <= 0) return false;
    ray.direction = line / ray.t_max;
    return true;
  };
  if (!aim()) return vec3(1);
  if (!transport.tables.any_pane) return transport.world.occluded(ray) ? vec3(0) : vec3(1);
  vec3 arrives(1);
  for (int pane = 0; pane < most_panes; pane++) {
    Hit hit = transport.world.intersect(ray);
    if (!hit.valid()) return arrives;
    uint32_t material = uint32_t(transport.world.mesh_of(hit.instance).material);
    if (!transport.tables.materials[material].maybe_pane) return vec3(0);
    Surface surface = eval_surface(transport.world, ray, hit);
    const Material& m = transport.world.material_of(hit.instance);
    if (!is_pane(surface, m)) return vec3(0);
    arrives *= pane_transmittance(surface, m, ray.direction);
    if (!(max_component(arrives) > 0)) return vec3(0);
    ray.origin = offset_origin(surface, ray.direction);
    if (!aim()) return arrives;
  }
  return vec3(0);
}

}  // namespace wellspring
