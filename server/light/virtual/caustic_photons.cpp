// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/caustic_photons.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/material/bsdf.h"
#include "light/random/warp.h"
#include "light/sample/caustic_casters.h"
#include "light/sample/emission.h"

namespace wellspring::light {
namespace {

// Returns a ray from a source towards the casters, its flux divided by the chance of choosing it.
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
    emitted.flux = place.radiance * (cosine * tables.emitters[pick.index].area / (pdf * chance));
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
    emitted.flux = eval_intensity(tables, pick.index - triangles, direction) / (pdf * chance);
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
  // Parallel light is aimed at a place on the discs that the spheres show to it.
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
  vec3 place =
      casters[chosen].center + radius * (std::cos(phi) * tangent + std::sin(phi) * bitangent);
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

// Calls visit(at, counts) as for_each_photons does, for photons that count for a surface lit from
// its front.
template <class Visit>
void for_each_counting(const PhotonGrid& grid, vec3 place, vec3 normal, int deepest,
                       PhotonCells& cells, const Visit& visit) {
  for_each_photons(grid, place, cells, [&](size_t at, LaneMask within) {
    Lanes alike = lanes_abs(grid.normal.x.at(at) * normal.x + grid.normal.y.at(at) * normal.y +
                            grid.normal.z.at(at) * normal.z);
    Lanes side = grid.direction.x.at(at) * normal.x + grid.direction.y.at(at) * normal.y +
                 grid.direction.z.at(at) * normal.z;
    LaneMask counts =
        within & (alike >= same_surface) & (side > grazing) & (grid.depth.at(at) <= float(deepest));
    if (negative_lanes(counts)) visit(at, counts);
  });
}

// Returns the flux that arrives around a place from its front.
vec3 sum_lambert(const PhotonGrid& grid, vec3 place, vec3 normal, int deepest, PhotonCells& cells) {
  Lanes red = all_lanes(0), green = red, blue = red, none = red;
  for_each_counting(grid, place, normal, deepest, cells, [&](size_t at, LaneMask counts) {
    red += counts ? grid.flux.x.at(at) : none;
    green += counts ? grid.flux.y.at(at) : none;
    blue += counts ? grid.flux.z.at(at) : none;
  });
  return {lanes_sum(red), lanes_sum(green), lanes_sum(blue)};
}

// Holds the light of such photons scattered by a bsdf that fits lanes, eight photons at a time.
// `diffuse` is to be multiplied by the reflectance.
struct Scattered {
  vec3 diffuse, specular;
};
Scattered sum_scattered(const PhotonGrid& grid, vec3 place, const Bsdf& bsdf, int deepest,
                        PhotonCells& cells) {
  const Lanes none = all_lanes(0);
  const vec3 normal = bsdf.geometric_normal;
  std::optional<BsdfLanes> lanes;  // made once there is something to scatter
  uint32_t found[lane_count];
  int count = 0;
  Lanes3 diffuse{none, none, none}, specular = diffuse;
  auto add = [&] {
    auto gather = [&](const PhotonColumns3& columns, vec3 fallback) {
      Lanes3 a;
      for (int i = 0; i < lane_count; i++) {
        vec3 v = i < count ? columns.at(found[i]) : fallback;
        a.x[i] = v.x, a.y[i] = v.y, a.z[i] = v.z;
      }
      return a;
    };
    Lanes3 direction = gather(grid.direction, normal), flux = gather(grid.flux, vec3(0));
    Lanes spread = 1 / (direction.x * normal.x + direction.y * normal.y + direction.z * normal.z);
    if (!lanes) lanes = make_bsdf_lanes(bsdf);
    BsdfLanesValue value = eval_bsdf_lanes(*lanes, direction);
    Lanes lambertian = value.diffuse * spread;
    diffuse.x += lambertian * flux.x, diffuse.y += lambertian * flux.y,
        diffuse.z += lambertian * flux.z;
    specular.x += value.specular.x * spread * flux.x;
    specular.y += value.specular.y * spread * flux.y;
    specular.z += value.specular.z * spread * flux.z;
    count = 0;
  };
  for_each_counting(grid, place, normal, deepest, cells, [&](size_t at, LaneMask counts) {
    for (unsigned bits = negative_lanes(counts); bits; bits &= bits - 1) {
      found[count++] = uint32_t(at) + uint32_t(std::countr_zero(bits));
      if (count == lane_count) add();
    }
  });
  if (count > 0) add();
  auto sum = [](const Lanes3& a) { return vec3(lanes_sum(a.x), lanes_sum(a.y), lanes_sum(a.z)); };
  return {sum(diffuse), sum(specular)};
}

}  // namespace

std::vector<Photon> shoot_caustic_photons(const Transport& transport,
                                          std::span<const CasterSphere> casters, int max_depth,
                                          uint64_t seed, uint32_t first, int count, float share) {
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
        photons.push_back({arrival.surface.position, uint32_t(walk.depth), arrival.flux * share,
                           -walk.ray.direction, arrival.surface.geometric_normal,
                           hue_of(walk.wavelengths)});
      if (!has_sharp(arrival.bsdf, sharp_alpha)) break;
      int before = walk.edges();
      std::optional<WavelengthSpread> spread;
      part_arrival(transport, walk, sampler, arrival, spread);
      if (!scatter(walk, arrival, spread, Lobes::specular, sampler)) break;
      sharp |= walk.edges() > before;  // not straight through a pane
    }
  }
  return photons;
}

void shade_by_photons(const Transport& transport, const PhotonGrid& grid, int max_depth,
                      const LitPlace& place, PhotonCells& cells, PlaceLight& light) {
  const Bsdf& bsdf = *place.bsdf;
  vec3 normal = bsdf.geometric_normal;
  bool sharp = has_sharp(bsdf, place.sharp);
  float hue = place.hue();
  bool hued = hue >= 0 && !grid.hue.values.empty();
  // The reflectance is the same for all directions.
  bool lambertian = !has_specular(bsdf) && bsdf.normal == normal && !hued;
  float area = pi * grid.radius * grid.radius;
  if (lambertian) {
    vec3 flux = sum_lambert(grid, place.surface->position, normal, max_depth - place.depth, cells);
    light.diffuse += flux * bsdf.diffuse / (pi * area);
    return;
  }
  if (!hued && fits_lanes(bsdf)) {
    Scattered sum =
        sum_scattered(grid, place.surface->position, bsdf, max_depth - place.depth, cells);
    light.diffuse += bsdf.diffuse * sum.diffuse / area;
    if (!sharp) light.specular += sum.specular / area;
    return;
  }
  vec3 diffuse(0), specular(0);
  for_each_photon(grid, place.surface->position, cells, [&](const Photon& photon) {
    if (int(photon.depth) + place.depth > max_depth) return;
    if (std::abs(dot(photon.normal, normal)) < same_surface) return;
    float cosine = std::abs(dot(photon.direction, normal));
    if (!(cosine > grazing)) return;
    BsdfValue value = eval_bsdf(bsdf, photon.direction);
    if (hued) {
      vec3 alike = meet_hues(*transport.tables.spectral, hue, photon.hue);
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
  return first * float(std::exp(0.5 * (std::lgamma(i + 1 + alpha) - std::lgamma(1 + alpha) -
                                       std::lgamma(i + 2))));
}

}  // namespace wellspring::light
