// SPDX-License-Identifier: Apache-2.0
#include "light/visible/see_through.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/parallel.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {
namespace {

constexpr size_t packet = 64;  // rays intersected before their surfaces are looked at

PrimaryHit see_nothing(const LightTables& tables, vec3 direction) {
  PrimaryHit seen;
  seen.normal = -direction;
  seen.distance = std::numeric_limits<float>::infinity();
  seen.glow = eval_environment(tables.environment, direction);
  return seen;
}

// The whole way, as samples go it: through panes and whatever the eye is in.
PrimaryHit see_slowly(const Transport& transport, const Ray& ray) {
  Request request;
  request.ray = ray;
  Sampler sampler(0, 0);
  Sample sample;
  FirstSurface first = find_first_surface(transport, 2, request, sampler, sample);
  PrimaryHit seen;
  seen.distance = sample.distance;
  seen.glow = sample.rest;
  bool hit = sample.flags & sample_hit;
  seen.normal = hit ? sample.normal : -ray.direction;
  if (!hit) return seen;
  seen.object = sample.object;
  seen.scatters = first.scatters;
  if (first.scatters) seen.albedo = first.tint * demodulated_reflectance(first).albedo;
  return seen;
}

PrimaryHit see_surface(const Transport& transport, const Ray& ray, const Hit& hit) {
  const World& world = transport.world;
  if (met_lambertian(transport, hit)) {
    LambertSurface surface = eval_lambert_surface(world, ray, hit);
    vec3 albedo = make_lambert(surface, ray.direction).reflectance;
    if (!(max_component(albedo) > least_albedo)) albedo = vec3(0);
    return {surface.normal, hit.t, albedo, vec3(0), world.object_of(hit.instance), true};
  }
  Surface surface = eval_surface(world, ray, hit);
  if (surface.transmission > 0 || surface.anisotropy > 0) return see_slowly(transport, ray);
  const Material& material = world.material_of(hit.instance);
  PrimaryHit seen;
  seen.normal = surface.normal;
  seen.distance = hit.t;
  seen.object = surface.object;
  seen.glow = surface_emission(surface, material);
  seen.scatters = !material.unlit;
  if (seen.scatters) seen.albedo = demodulated_albedo(surface, traits_of(transport, hit).metal);
  return seen;
}

void see_packet(const Transport& transport, std::span<const Ray> rays, PrimaryHit* seen) {
  const LightTables& tables = transport.tables;
  const World& world = transport.world;
  Hit hits[packet];
  bool plain = !tables.any_solid;
  if (plain) world.intersect_many(rays.data(), hits, int(rays.size()));
  for (size_t i = 0; i < rays.size(); i++) {
    const Hit& hit = hits[i];
    bool pane = plain && hit.valid() && traits_of(transport, hit).maybe_pane;
    if (!plain || pane) seen[i] = see_slowly(transport, rays[i]);
    else if (hit.valid()) seen[i] = see_surface(transport, rays[i], hit);
    else seen[i] = see_nothing(tables, rays[i].direction);
  }
}

}  // namespace

void see(const World& world, const Lights& lights, std::span<const Ray> rays,
         std::span<PrimaryHit> seen) {
  if (rays.size() != seen.size()) throw std::invalid_argument("see: one answer a ray");
  Transport transport{world, *lights.tables};
  int packets = int((rays.size() + packet - 1) / packet);
  parallel_ranges(packets, 4, [&](int begin, int end) {
    for (size_t start = size_t(begin) * packet; start < size_t(end) * packet; start += packet)
      see_packet(transport, rays.subspan(start, std::min(rays.size() - start, packet)),
                 &seen[start]);
  });
}

}  // namespace wellspring::light
