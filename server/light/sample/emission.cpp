// SPDX-License-Identifier: Apache-2.0
#include "light/sample/emission.h"

#include <algorithm>
#include <cmath>

#include "light/random/warp.h"
#include "light/sample/light_tables.h"
#include "light/sample/transport.h"

namespace wellspring::light {
namespace {

vec3 from_frame(vec3 axis, vec3 local) {
  vec3 tangent, bitangent;
  make_frame_axes(axis, tangent, bitangent);
  return tangent * local.x + bitangent * local.y + axis * local.z;
}

// Returns a ray that enters the scene along `direction`, anywhere on a disc that hides the scene.
Ray ray_from_outside(const EmissionChoice& choice, vec3 direction, vec2 u) {
  float radius = choice.radius * std::sqrt(u.x), phi = 2 * pi * u.y;
  Ray ray;
  ray.direction = direction;
  ray.origin = choice.centre - direction * (2 * choice.radius) +
               from_frame(direction, {radius * std::cos(phi), radius * std::sin(phi), 0});
  return ray;
}

float disc_area(const EmissionChoice& choice) { return pi * choice.radius * choice.radius; }

void leave_emitter(const Transport& transport, uint32_t triangle, vec2 u, float chance,
                   Sampler& sampler, EmittedRay& emitted) {
  const EmitterTriangle& e = transport.tables.emitters[triangle];
  EmitterPlace place = sample_emitter_place(transport, triangle, u);
  vec2 way = sampler.next2();
  float sides = 1;
  vec3 normal = e.normal;
  if (e.double_sided) {
    sides = 2;
    if (way.x < 0.5f) normal = -normal;
    way.x = way.x < 0.5f ? 2 * way.x : 2 * way.x - 1;
  }
  emitted.ray.direction = from_frame(normal, sample_cosine_hemisphere(way));
  emitted.ray.origin = offset_origin(place.surface, emitted.ray.direction);
  emitted.flux = place.radiance * (pi * e.area * sides / chance);
}

void leave_punctual(const Transport& transport, size_t index, vec2 u, float chance,
                    EmittedRay& emitted) {
  const PunctualLight& light = transport.tables.punctual[index];
  if (light.type == PunctualType::directional) {
    emitted.ray = ray_from_outside(transport.tables.emission, light.direction, u);
    emitted.flux = light.intensity * (disc_area(transport.tables.emission) / chance);
    return;
  }
  float lowest = light.type == PunctualType::spot ? transport.tables.cones[index].outer : -1.0f;
  float z = 1 - u.x * (1 - lowest), radius = std::sqrt(std::max(0.0f, 1 - z * z)),
        phi = 2 * pi * u.y;
  emitted.ray.origin = light.position;
  emitted.ray.direction =
      from_frame(light.direction, {radius * std::cos(phi), radius * std::sin(phi), z});
  emitted.flux = eval_intensity(transport.tables, index, emitted.ray.direction) *
                 (2 * pi * (1 - lowest) / chance);
  emitted.range = light.range;
}

void leave_environment(const Transport& transport, float chance, Sampler& sampler,
                       EmittedRay& emitted) {
  const EnvironmentLight& environment = transport.tables.environment;
  EnvironmentSample sky = sample_whole_sky(environment, sampler.next2());
  if (!(sky.pdf > 0)) return;
  emitted.ray = ray_from_outside(transport.tables.emission, -sky.direction, sampler.next2());
  emitted.flux = eval_environment(environment, sky.direction) *
                 (disc_area(transport.tables.emission) / (sky.pdf * chance));
}

}  // namespace

EmissionChoice make_emission_choice(const LightTables& tables, std::span<const float> emitter_power,
                                    std::span<const float> punctual_power, float environment_power,
                                    const Bounds& bounds) {
  EmissionChoice choice;
  choice.exact_punctual = tables.punctual.size() <= most_exact_punctual;
  vec3 size = bounds.high - bounds.low;
  if (is_finite(size) && size.x >= 0) {
    choice.centre = bounds.low + 0.5f * size;
    choice.radius = std::max(0.5001f * length(size), 1e-6f);
  }
  std::vector<float> weights(emitter_power.begin(), emitter_power.end());
  weights.insert(weights.end(), punctual_power.begin(), punctual_power.end());
  weights.push_back(environment_power);
  choice.rays = make_alias_table(weights);
  if (!tables.environment.is_sampled()) weights.back() = 0;
  choice.caustics = make_alias_table(weights);
  weights.back() = environment_power;
  if (choice.exact_punctual)
    std::fill_n(weights.begin() + long(emitter_power.size()), punctual_power.size(), 0.0f);
  choice.places = make_alias_table(weights);
  return choice;
}

EmitterPlace eval_emitter_place(const Transport& transport, uint32_t triangle, vec2 barycentric) {
  const EmitterTriangle& e = transport.tables.emitters[triangle];
  EmitterPlace place;
  place.surface.position = e.corner + barycentric.x * e.edge1 + barycentric.y * e.edge2;
  place.surface.geometric_normal = e.normal;
  place.surface.extent = e.extent;
  place.radiance = e.emission;
  place.double_sided = e.double_sided;
  if (e.uniform) return place;
  Ray ray;
  ray.origin = place.surface.position + e.normal;
  ray.direction = -e.normal;
  Hit hit;
  hit.t = 1;
  hit.instance = e.instance;
  hit.triangle = e.triangle;
  hit.barycentric = barycentric;
  Surface shown = eval_surface(transport.world, ray, hit);
  const Material& material = transport.world.material_of(e.instance);
  float cover = 1;
  if (material.alpha_mode == AlphaMode::mask) cover = shown.alpha < material.alpha_cutoff ? 0 : 1;
  if (material.alpha_mode == AlphaMode::blend) cover = shown.alpha;
  place.radiance = surface_emission(shown, material) * cover;
  return place;
}

EmitterPlace sample_emitter_place(const Transport& transport, uint32_t triangle, vec2 u) {
  int picture = transport.tables.emitters[triangle].picture;
  if (picture < 0) return eval_emitter_place(transport, triangle, sample_triangle(u));
  PicturePlace chosen = sample_emission_picture(transport.tables.pictures[size_t(picture)], u);
  EmitterPlace place = eval_emitter_place(transport, triangle, chosen.barycentric);
  place.radiance = chosen.density > 0 ? place.radiance / chosen.density : vec3(0);
  return place;
}

EmittedRay sample_emitted_ray(const Transport& transport, Sampler& sampler) {
  const LightTables& tables = transport.tables;
  EmittedRay emitted;
  if (tables.emission.rays.cells.empty()) return emitted;
  vec2 u = sampler.next2();
  AliasPick pick = sample_alias(tables.emission.rays, u.x);
  u.x = pick.u;
  float chance = tables.emission.rays.cells[pick.index].probability;
  if (!(chance > 0)) return emitted;
  size_t triangles = tables.emitters.size(), punctual = tables.punctual.size();
  if (pick.index < triangles) leave_emitter(transport, pick.index, u, chance, sampler, emitted);
  else if (pick.index < triangles + punctual)
    leave_punctual(transport, pick.index - triangles, u, chance, emitted);
  else leave_environment(transport, chance, sampler, emitted);
  return emitted;
}

EnvironmentSample sample_whole_sky(const EnvironmentLight& environment, vec2 u) {
  if (!environment.cells.cells.empty()) return sample_environment(environment, u);
  constexpr float all = 1 / (4 * pi);
  if (!environment.is_sampled()) return {sample_sphere(u), all};
  if (!(luminance(environment.radiance) > 0)) return sample_environment(environment, u);
  // A sun in a plain sky: each is drawn half of the time.
  bool sun = u.x < 0.5f;
  u.x = sun ? 2 * u.x : 2 * u.x - 1;
  vec3 direction = sun ? sample_environment(environment, u).direction : sample_sphere(u);
  return {direction, 0.5f * all + 0.5f * sample_environment_pdf(environment, direction)};
}

float range_window(float distance, float range) {
  if (!std::isfinite(range) || !(range > 0)) return 1;
  float ratio = distance / range, r2 = ratio * ratio;
  return glm::clamp(1 - r2 * r2, 0.0f, 1.0f);
}

vec3 eval_intensity(const LightTables& tables, size_t punctual, vec3 direction) {
  const PunctualLight& light = tables.punctual[punctual];
  if (light.type != PunctualType::spot) return light.intensity;
  const SpotCone& cone = tables.cones[punctual];
  float t = glm::clamp((dot(direction, light.direction) - cone.outer) * cone.scale, 0.0f, 1.0f);
  return light.intensity * (t * t);
}

}  // namespace wellspring::light
