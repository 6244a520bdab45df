// SPDX-License-Identifier: Apache-2.0
#include "light/walk/light_walk.h"

#include <algorithm>
#include <cmath>

#include "light/sample/emission.h"
#include "light/walk/walk.h"

namespace wellspring::light {
namespace {

// Returns the factor of Veach 1997, equation 5.19: flux is conserved per geometric area, lobes are
// written for the shading normal.
float adjoint_factor(const Bsdf& bsdf, vec3 came_from, vec3 direction) {
  float in = std::abs(dot(came_from, bsdf.geometric_normal));
  float out = std::abs(dot(direction, bsdf.normal));
  if (!(in > 1e-5f) || !(out > 1e-5f)) return 0;
  return bsdf.view.z * std::abs(dot(direction, bsdf.geometric_normal)) / (in * out);
}

vec3 came_from(const Bsdf& b) {
  return b.tangent * b.view.x + b.bitangent * b.view.y + b.normal * b.view.z;
}

}  // namespace

float smoothest_alpha(const Bsdf& bsdf) {
  float base = std::min({bsdf.alpha, bsdf.alphas.x, bsdf.alphas.y});
  return bsdf.clearcoat.strength > 0 ? std::min(base, bsdf.clearcoat.alpha) : base;
}

bool has_blurred(const Bsdf& bsdf) {
  return bsdf.alpha > 0 || max_component(bsdf.sheen.color) > 0 ||
         (bsdf.clearcoat.strength > 0 && bsdf.clearcoat.alpha > 0);
}

bool has_sharp(const Bsdf& bsdf, float alpha) {
  return has_specular(bsdf) && smoothest_alpha(bsdf) < alpha;
}

bool has_rough(const Bsdf& bsdf, float alpha) {
  return has_diffuse(bsdf) || (has_specular(bsdf) && smoothest_alpha(bsdf) >= alpha);
}

bool arrive(const Transport& transport, LightWalk& walk, Arrival& arrival) {
  if (!(max_component(walk.flux) > 0) || !is_finite(walk.flux)) return false;
  const World& world = transport.world;
  Hit hit = world.intersect(walk.ray);
  if (!hit.valid() || world.meet_volume(walk.ray, hit.t, false)) return false;
  if (transport.tables.any_solid && walk.edges() == 1 && walk.panes == 0)
    walk.media.here = find_media(transport, walk.ray.origin);
  arrival.surface = meet_surface(transport, walk.ray, hit, walk.media);
  const Surface& surface = arrival.surface;
  const Material& material = world.material_of(hit.instance);
  walk.flux *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
  walk.run += hit.t;
  arrival.flux = walk.flux * range_window(walk.run, walk.range);
  arrival.lit = !material.unlit;
  if (arrival.lit)
    arrival.bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
  return true;
}

bool scatter(LightWalk& walk, const Arrival& arrival, const BsdfSample& scattered,
             Sampler& sampler) {
  if (!(max_component(scattered.weight) > 0)) return false;
  const Bsdf& b = arrival.bsdf;
  bool passes = scattered.bounce == Bounce::pass;
  vec3 had = passes ? walk.flux : arrival.flux;
  vec3 flux = had * scattered.weight;
  if (!passes) {
    flux *= adjoint_factor(b, came_from(b), scattered.direction);
    if (scattered.bounce == Bounce::refract) flux *= b.eta * b.eta;
  }
  float chance = std::min(1.0f, max_component(flux) / max_component(had));
  if (scattered.glass && ++walk.glass > sure_glass) chance *= glass_survival;
  if (walk.glass > most_glass) return false;
  if (!(sampler.next() < chance)) return false;
  walk.flux = flux / chance;
  walk.ray.origin = offset_origin(arrival.surface, scattered.direction);
  walk.ray.direction = scattered.direction;
  if (passes) return ++walk.panes <= most_panes;
  if (scattered.bounce == Bounce::refract) walk.media.here = walk.media.beyond;
  walk.panes = 0;
  walk.run = 0;
  walk.range = std::numeric_limits<float>::infinity();
  if (!scattered.glass) walk.depth++;
  return true;
}

void part_arrival(const Transport& transport, const LightWalk& walk, Sampler& sampler,
                  Arrival& arrival, std::optional<WavelengthSpread>& spread) {
  if (!arrival.lit || !parts_colors(transport, walk.media, arrival.surface)) return;
  part_colors(transport, walk.media, walk.ray.direction, arrival.surface, walk.wavelengths, sampler,
              arrival.bsdf, spread);
  arrival.bsdf.spread = nullptr;  // `spread` does not live as long
}

bool scatter(LightWalk& walk, const Arrival& arrival, const std::optional<WavelengthSpread>& spread,
             Lobes lobes, Sampler& sampler) {
  BsdfSample scattered = sample_bsdf(arrival.bsdf, lobes, sampler);
  // Refracted light is squeezed by each wavelength's own index: the hero goes on alone.
  if (spread && scattered.bounce == Bounce::refract) carry_hero(*spread, walk.wavelengths);
  else if (spread) carry_wavelengths(*spread, arrival.bsdf, lobes, scattered, walk.wavelengths);
  if (spread) tint_weight(*spread, walk.wavelengths, scattered);
  return scatter(walk, arrival, scattered, sampler);
}

vec3 eval_scattered(const Arrival& arrival, vec3 direction) {
  const Bsdf& b = arrival.bsdf;
  BsdfValue value = eval_bsdf(b, direction);
  vec3 rough = value.diffuse + (has_sharp(b, sharp_alpha) ? vec3(0) : value.specular);
  if (!(max_component(rough) > 0)) return vec3(0);
  float factor = adjoint_factor(b, came_from(b), direction);
  if (dot(direction, b.geometric_normal) < 0) factor *= b.thin ? 1 : b.eta * b.eta;
  return rough * factor;
}

}  // namespace wellspring::light
