// SPDX-License-Identifier: Apache-2.0
#include "light/instant/eye_light.h"

#include <algorithm>
#include <cmath>

#include "light/instant/caustic_photons.h"
#include "light/instant/point_lights_simd.h"
#include "light/sample/medium.h"
#include "light/walk/part_colors.h"

namespace wellspring::light {

void part_seen_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                      Sampler& sampler, Bsdf& bsdf, std::optional<WavelengthSpread>& spread) {
  if (!parts_colors(transport, walk.media, surface)) return;
  float u = walk.wavelengths.carried == 0 ? sampler.next() : 0;
  part_colors(transport, walk.media, walk.ray.direction, surface, walk.wavelengths, u, bsdf,
              spread);
}

namespace {

// What is seen in mirrors is not filtered, so more than one set lights it; a faint image makes do
// with fewer of the lights, asked of each set, and so does what is gathered from nearby, a small
// part of all.
constexpr int mirror_sets = 2, near_lights = 2, chained_lights = 6, most_lights = 16;
int mirror_lights(const Walk& walk) {
  float bright = max_component(walk.throughput);
  return bright > 0.5f ? 8 : bright > 0.25f ? 5 : 3;
}
constexpr int mirror_depth = 6;  // chains are not cut short at random before

// Radiance scattered towards where `walk` came from by the rough lobes of what it met.
vec3 eval_rough(const EyeLight& eye, const Walk& walk, const Surface& surface, const Bsdf& bsdf,
                float sharp, int sets, int lights, Sampler& sampler) {
  if (walk.depth >= eye.max_depth || !has_rough(bsdf, sharp)) return vec3(0);
  LitPlace place{&surface, &bsdf, &walk.media, walk.depth, sharp, &walk.wavelengths};
  PlaceLight light;
  int all = eye.pass.sets(), asked = std::min(sets, all);
  for (int i = 0; i < asked; i++) {
    RegionLight chosen[most_lights];
    int set = (eye.set + i) % all;
    int count =
        choose_place_lights(eye.pass, set, surface.position, bsdf, lights, sampler.next(), chosen);
    if (count > 0)
      shade_by_point_lights(eye.transport, eye.pass,
                            {set, 0, 1, 0, -1, 0, std::span(chosen, size_t(count))}, eye.max_depth,
                            &place, 1, &light);
  }
  if (!eye.pass.photons.empty())
    for (int i = 0; i < asked; i++) {
      PhotonCells cells;
      shade_by_photons(eye.pass.photons[size_t((eye.set + i) % all)], eye.max_depth, place, cells,
                       light);
    }
  vec3 radiance = light.sum() / float(asked);
  PlaceLight rest;
  gather_rest(eye, place, sampler, rest);
  return radiance + rest.sum();
}

// Lets a walk live with a chance of its throughput.
bool survives(Walk& walk, float importance, Sampler& sampler) {
  const float most = walk.glass > sure_glass ? glass_survival : 1;
  float chance = std::min(most, max_component(walk.throughput) * importance);
  if (!(sampler.next() < chance)) return false;
  walk.throughput /= chance;
  return true;
}

// The walk's ray ends at `hit`.
struct Met {
  Surface surface;
  const Material* material;
  Bsdf bsdf;
  std::optional<WavelengthSpread> spread;  // where it parts colours; bsdf refers to it
};
void meet(const Transport& transport, Hit& hit, Sampler& sampler, Walk& walk, Met& met) {
  met.surface = meet_surface(transport, walk.ray, hit, walk.media);
  met.material = &transport.world.material_of(hit.instance);
  walk.throughput *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
  met.bsdf = make_bsdf_in(transport, walk.media, met.surface, *met.material, walk.ray.direction);
  part_seen_colors(transport, walk, met.surface, sampler, met.bsdf, met.spread);
}

bool go_on(Walk& walk, const Met& met, const BsdfSample& scattered) {
  if (scattered.bounce == Bounce::refract) walk.density *= met.bsdf.eta * met.bsdf.eta;
  return advance(walk, met.surface, scattered);
}

// Of a sky without a picture's brightness to go by: what photons do not bring.
vec3 plain_sky(const EnvironmentLight& environment, vec3 direction) {
  vec3 sky = eval_environment(environment, direction);
  return sample_environment_pdf(environment, direction) > 0 ? sky - environment.sun_radiance : sky;
}

}  // namespace

vec3 gather_along(const EyeLight& eye, Walk walk, Sampler& sampler) {
  const Transport& transport = eye.transport;
  const LightTables& tables = transport.tables;
  float clip = eye.pass.compensate ? eye.pass.clip : 0;
  float run = 0;
  bool chained = false;  // a sharp lobe was on the way
  vec3 radiance(0);
  for (int i = 0; i < most_panes; i++) {
    if (!eye.pass.sharp) walk.ray.t_max = clip - run;
    Hit hit = transport.world.intersect(walk.ray);
    if (!hit.valid()) {
      if (chained && tables.environment.cells.cells.empty())
        radiance += walk.throughput * plain_sky(tables.environment, walk.ray.direction);
      return radiance;
    }
    run += hit.t;
    Met met;
    meet(transport, hit, sampler, walk, met);
    float taken = chained ? 1.0f : run < clip ? 1 - run * run / (clip * clip) : 0.0f;
    if (taken > 0) {
      if (!chained && tables.first_emitter[hit.instance] != no_emitter)
        radiance += walk.throughput * taken * surface_emission(met.surface, *met.material);
      Walk asked = walk;
      asked.throughput *= taken;
      if (!met.material->unlit && survives(asked, 1, sampler))
        radiance += asked.throughput * eval_rough(eye, walk, met.surface, met.bsdf, sharp_alpha, 1,
                                                  chained ? chained_lights : near_lights, sampler);
    }
    if (met.material->unlit || !eye.pass.sharp || !has_sharp(met.bsdf, sharp_alpha) ||
        walk.depth >= eye.max_depth)
      return radiance;
    BsdfSample scattered = sample_bsdf(met.bsdf, Lobes::specular, sampler);
    if (met.spread)
      carry_wavelengths(*met.spread, met.bsdf, Lobes::specular, scattered, walk.wavelengths);
    if (!go_on(walk, met, scattered)) return radiance;
    chained |= scattered.bounce != Bounce::pass;
    if (!survives(walk, walk.density, sampler)) return radiance;
  }
  return radiance;
}

void gather_rest(const EyeLight& eye, const LitPlace& place, Sampler& sampler, PlaceLight& light) {
  bool clipped = eye.pass.compensate && eye.pass.clip > 0;
  if ((!clipped && !eye.pass.sharp) || place.depth >= eye.max_depth) return;
  const Bsdf& bsdf = *place.bsdf;
  bool sharp = has_sharp(bsdf, place.sharp);
  if (sharp && !has_diffuse(bsdf)) return;
  BsdfSample scattered = sample_bsdf(bsdf, sharp ? Lobes::diffuse : Lobes::all, sampler);
  if (!(scattered.pdf > 0)) return;
  BsdfValue value = eval_bsdf(bsdf, scattered.direction);
  Walk walk;
  walk.depth = place.depth;
  walk.media = *place.media;
  if (place.wavelengths) walk.wavelengths = *place.wavelengths;
  scattered.weight = vec3(1);
  if (!advance(walk, *place.surface, scattered)) return;
  vec3 radiance = gather_along(eye, walk, sampler) / scattered.pdf;
  light.diffuse += value.diffuse * radiance;
  if (!sharp) light.specular += value.specular * radiance;
}

vec3 follow_mirrors(const EyeLight& eye, Walk walk, Sampler& sampler) {
  const Transport& transport = eye.transport;
  vec3 radiance(0);
  for (int i = 0; i < most_panes + most_glass; i++) {
    Hit hit = transport.world.intersect(walk.ray);
    if (!hit.valid()) return radiance + walk.throughput * walk_met_sky(transport, walk);
    Met met;
    meet(transport, hit, sampler, walk, met);
    radiance += walk.throughput * walk_met_emission(transport, walk, met.surface, *met.material);
    if (met.material->unlit) return radiance;
    bool last = walk.depth >= eye.max_depth && !is_clear_solid(met.bsdf);
    if (!last) {
      int asked = mirror_lights(walk);
      radiance += walk.throughput * eval_rough(eye, walk, met.surface, met.bsdf, mirror_alpha,
                                               asked > 5 ? mirror_sets : 1, asked, sampler);
    }
    BsdfSample scattered;
    if (last) {  // only straight on, where a shadow ray would have gone too
      if (!is_pane(met.surface, *met.material)) return radiance;
      scattered.direction = walk.ray.direction;
      scattered.weight = pane_transmittance(met.surface, *met.material, walk.ray.direction);
      scattered.bounce = Bounce::pass;
    } else {
      if (!has_sharp(met.bsdf, mirror_alpha)) return radiance;
      if (has_blurred(met.bsdf))
        radiance +=
            walk.throughput *
            sample_direct_light(transport, walk, met.surface, met.bsdf, true, sampler).specular;
      scattered = sample_bsdf(met.bsdf, Lobes::specular, sampler);
      if (met.spread)
        carry_wavelengths(*met.spread, met.bsdf, Lobes::specular, scattered, walk.wavelengths);
    }
    if (!go_on(walk, met, scattered) || walk.depth > eye.max_depth) return radiance;
    if (scattered.bounce != Bounce::pass)
      walk.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (walk.edges() > mirror_depth && !survives(walk, walk.density, sampler)) return radiance;
  }
  return radiance;
}

}  // namespace wellspring::light
