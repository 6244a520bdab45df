// SPDX-License-Identifier: Apache-2.0
#include "light/caustic_photons.h"

#include <algorithm>
#include <cmath>

#include "light/emission.h"
#include "light/warp.h"

namespace wellspring {
namespace {

// A ray from a source towards the casters, its flux divided by the chance of choosing it.
EmittedRay aim_at_casters(const Transport& transport, std::span<const CasterSphere> casters,
                          Sampler& sampler) {
  const LightTables& tables = transport.tables;
  const AliasTable& choice = tables.emission.caustics;
  EmittedRay emitted;
  vec2 u = sampler.next2();
  AliasPick pick = sample_alias(choice, u.x);
  float chance = choice.cells[pick.index].probability;
  if (!(chance > 0)) return emitted;
  size_t triangles = tables.emitters.size(), punctual = tables.punctual.size();
  vec2 aim = sampler.next2();
  if (pick.index < triangles) {
    EmitterPlace place = sample_emitter_place(transport, pick.index, {pick.u, u.y});
    vec3 direction = sample_caster(casters, place.surface.position, aim);
    float pdf = sample_caster_pdf(casters, place.surface.position, direction);
    float cosine = dot(direction, place.surface.geometric_normal);
    if (place.double_sided) cosine = std::abs(cosine);
    if (!(pdf > 0) || !(cosine > 0)) return emitted;
    emitted.ray.direction = direction;
    emitted.ray.origin = offset_origin(place.surface, direction);
    emitted.flux =
        place.radiance * (cosine * tables.emitters[pick.index].area / (pdf * chance));
    return emitted;
  }
  const PunctualLight* light =
      pick.index < triangles + punctual ? &tables.punctual[pick.index - triangles] : nullptr;
  if (light && light->type != PunctualType::directional) {
    vec3 direction = sample_caster(casters, light->position, aim);
    float pdf = sample_caster_pdf(casters, light->position, direction);
    if (!(pdf > 0)) return emitted;
    emitted.ray.origin = light->position;
    emitted.ray.direction = direction;
    emitted.flux =
        eval_intensity(tables, pick.index - triangles, direction) / (pdf * chance);
    emitted.range = light->range;
    return emitted;
  }
  vec3 direction, radiance;
  if (light) {
    direction = light->direction;
    radiance = light->intensity;
  } else {
    const EnvironmentLight& environment = tables.environment;
    EnvironmentSample sky = sample_environment(environment, sampler);
    if (!(sky.pdf > 0)) return emitted;
    direction = -sky.direction;
    radiance = (environment.cells.cells.empty() ? environment.sun_radiance
                                                : eval_environment(environment, sky.direction)) /
               sky.pdf;
  }
  // Parallel light: a place on the discs that the spheres show to it.
  float total = 0;
  for (const CasterSphere& c : casters) total += c.weight * c.radius * c.radius;
  float left = sampler.next() * total;
  size_t chosen = 0;
  while (chosen + 1 < casters.size() &&
         left >= casters[chosen].weight * casters[chosen].radius * casters[chosen].radius) {
    left -= casters[chosen].weight * casters[chosen].radius * casters[chosen].radius;
    chosen++;
  }
  vec3 tangent, bitangent;
  make_frame_axes(direction, tangent, bitangent);
  float radius = casters[chosen].radius * std::sqrt(aim.x), phi = 2 * pi * aim.y;
  vec3 place = casters[chosen].center + radius * (std::cos(phi) * tangent + std::sin(phi) * bitangent);
  float density = 0;
  for (const CasterSphere& c : casters) {
    vec3 away = place - c.center;
    away -= direction * dot(away, direction);
    if (dot(away, away) <= c.radius * c.radius * 1.000001f) density += c.weight / (pi * total);
  }
  if (!(density > 0)) return emitted;
  const EmissionChoice& scene = tables.emission;
  float back = length(place - scene.centre) + 2 * scene.radius;
  emitted.ray.origin = place - direction * back;
  emitted.ray.direction = direction;
  emitted.flux = radiance / (density * chance);
  return emitted;
}

constexpr float same_surface = 0.7f;  // least cosine between normals
constexpr float grazing = 1e-3f;      // photons flatter than this do not count

// Flux that arrives around a place from before it.
vec3 sum_matt(const PhotonGrid& grid, vec3 place, vec3 normal, int deepest) {
  Lanes red = all_lanes(0), green = red, blue = red, none = red;
  for_each_photons(grid, place, [&](size_t at, LaneMask within) {
    Lanes alike = lanes_abs(grid.normal.x.at(at) * normal.x + grid.normal.y.at(at) * normal.y +
                            grid.normal.z.at(at) * normal.z);
    Lanes side = grid.direction.x.at(at) * normal.x + grid.direction.y.at(at) * normal.y +
                 grid.direction.z.at(at) * normal.z;
    LaneMask counts = within & (alike >= same_surface) & (side > grazing) &
                      (grid.depth.at(at) <= float(deepest));
    red += counts ? grid.flux.x.at(at) : none;
    green += counts ? grid.flux.y.at(at) : none;
    blue += counts ? grid.flux.z.at(at) : none;
  });
  return {lanes_sum(red), lanes_sum(green), lanes_sum(blue)};
}

}  // namespace

std::vector<Photon> shoot_caustic_photons(const Transport& transport,
                                          std::span<const CasterSphere> casters, int max_depth,
                                          uint64_t seed, uint32_t first, int count,
                                          float share) {
  std::vector<Photon> photons;
  if (casters.empty() || transport.tables.emission.caustics.cells.empty()) return photons;
  for (int i = 0; i < count; i++) {
    Sampler sampler(seed, first + uint32_t(i));
    EmittedRay emitted = aim_at_casters(transport, casters, sampler);
    LightWalk walk;
    walk.ray = emitted.ray;
    walk.flux = emitted.flux;
    walk.range = emitted.range;
    Arrival arrival;
    bool sharp = false;
    while (walk.depth < max_depth && arrive(transport, walk, arrival) && arrival.lit) {
      if (sharp && has_rough(arrival.bsdf, sharp_alpha))
        photons.push_back({arrival.surface.position, uint32_t(walk.depth),
                           arrival.flux * share, -walk.ray.direction,
                           arrival.surface.geometric_normal, hue_of(walk.wavelengths)});
      if (!has_sharp(arrival.bsdf, sharp_alpha)) break;
      int before = walk.depth;
      std::optional<WavelengthSpread> spread;
      part_arrival(transport, walk, sampler, arrival, spread);
      if (!scatter(walk, arrival, spread, Lobes::specular, sampler)) break;
      sharp |= walk.depth > before;  // not straight through a pane
    }
  }
  return photons;
}

void shade_by_photons(const PhotonGrid& grid, int max_depth, const LitPlace& place,
                      PlaceLight& light) {
  const Bsdf& bsdf = *place.bsdf;
  vec3 normal = bsdf.geometric_normal;
  bool sharp = has_sharp(bsdf, place.sharp);
  float hue = place.hue();
  bool hued = hue >= 0 && !grid.hue.values.empty();
  // One reflectance for all directions.
  bool matt = !has_specular(bsdf) && bsdf.normal == normal && !hued;
  float area = pi * grid.radius * grid.radius;
  if (matt) {
    vec3 flux = sum_matt(grid, place.surface->position, normal, max_depth - place.depth);
    light.diffuse += flux * bsdf.diffuse / (pi * area);
    return;
  }
  vec3 diffuse(0), specular(0);
  for_each_photon(grid, place.surface->position, [&](const Photon& photon) {
    if (int(photon.depth) + place.depth > max_depth) return;
    if (std::abs(dot(photon.normal, normal)) < same_surface) return;
    float cosine = std::abs(dot(photon.direction, normal));
    if (!(cosine > grazing)) return;
    BsdfValue value = eval_bsdf(bsdf, photon.direction);
    if (hued) {
      vec3 alike = meet_hues(hue, photon.hue);
      value.diffuse *= alike, value.specular *= alike;
    }
    diffuse += value.diffuse * photon.flux / cosine;
    if (!sharp) specular += value.specular * photon.flux / cosine;
  });
  light.diffuse += diffuse / area;
  light.specular += specular / area;
}

float shrunk_radius(float first, uint32_t index) {
  constexpr double alpha = 2.0 / 3;
  double i = double(index);
  return first *
         float(std::exp(0.5 * (std::lgamma(i + 1 + alpha) - std::lgamma(1 + alpha) -
                               std::lgamma(i + 2))));
}

}  // namespace wellspring
