// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/eye_light.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "light/material/lambert.h"
#include "light/random/sampler.h"
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"
#include "light/virtual/caustic_photons.h"
#include "light/virtual/virtual_lights.h"
#include "light/walk/first_surface.h"
#include "light/walk/trace_lambert.h"
#include "light/walk/walk.h"
#include "world/world_packet.h"

namespace wellspring::light {

void part_seen_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                      Sampler& sampler, Bsdf& bsdf, std::optional<WavelengthSpread>& spread) {
  if (!parts_colors(transport, walk.media, surface)) return;
  part_colors(transport, walk.media, walk.ray.direction, surface, walk.wavelengths, sampler, bsdf,
              spread);
}

namespace {

// Mirror images are not filtered, so more than one set lights them; a faint image makes do with
// fewer lights of each set, and so does light gathered from nearby, a small part of all.
constexpr int mirror_sets = 2, near_lights = 2, chained_lights = 6, most_lights = 16;
int mirror_lights(const Walk& walk) {
  float bright = max_component(walk.throughput);
  return bright > 0.5f ? 8 : bright > 0.25f ? 5 : 3;
}
constexpr int mirror_depth = 6;  // edges of a chain before it may be cut short at random

// Tells the walk's wavelengths of a sample of the specular lobes; its throughput takes their tint,
// as light of virtual lights has a colour.
void carry_colors(const WavelengthSpread& spread, const Bsdf& bsdf, BsdfSample& scattered,
                  Walk& walk) {
  carry_wavelengths(spread, bsdf, Lobes::specular, scattered, walk.wavelengths);
  tint_weight(spread, walk.wavelengths, scattered);
}

// Returns the radiance scattered towards the origin of `walk` by the rough lobes of the surface
// that it met.
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
      shade_by_photons(eye.transport, eye.pass.photons[size_t((eye.set + i) % all)], eye.max_depth,
                       place, cells, light);
    }
  vec3 radiance = light.sum() / float(asked);
  PlaceLight rest;
  gather_rest(eye, place, sampler, rest);
  return radiance + rest.sum();
}

// Lets a walk go on with a chance of its throughput.
bool survives(Walk& walk, float importance, Sampler& sampler) {
  const float most = walk.glass > sure_glass ? glass_survival : 1;
  float chance = std::min(most, max_component(walk.throughput) * importance);
  if (!(sampler.next() < chance)) return false;
  walk.throughput /= chance;
  return true;
}

// Holds the surface that a walk's ray met.
struct Met {
  Surface surface;
  const Material* material;
  Bsdf bsdf;
  std::optional<WavelengthSpread> spread;  // if the surface parts colours; bsdf refers to it
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

// Returns the light that photons do not bring from a sky without a picture's brightness to go by:
// all but the sun's.
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
  bool chained = false;  // whether a sharp lobe was on the way
  vec3 radiance(0);
  for (int i = 0; i < most_panes; i++) {
    if (!eye.pass.sharp) walk.ray.t_max = clip - run;
    Hit hit = transport.world.intersect(walk.ray);
    vec3 unseen(0);
    if (ends_in_volume(transport, walk, std::min(hit.t, walk.ray.t_max),
                       chained ? radiance : unseen))
      return radiance;
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
    if (met.spread) carry_colors(*met.spread, met.bsdf, scattered, walk);
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
    if (ends_in_volume(transport, walk, hit.t, radiance)) return radiance;
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
    if (last) {  // the walk goes only straight on, as a shadow ray would have
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
      if (met.spread) carry_colors(*met.spread, met.bsdf, scattered, walk);
    }
    if (!go_on(walk, met, scattered) || walk.depth > eye.max_depth) return radiance;
    if (scattered.bounce != Bounce::pass)
      walk.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (walk.edges() > mirror_depth && !survives(walk, walk.density, sampler)) return radiance;
  }
  return radiance;
}

namespace {

constexpr int item_bits = 22, list_bits = 10;

// Holds up to 16 eyes of one group.
struct Packet {
  std::span<const LambertHit> eyes;
  uint32_t items[RayPacket::lanes];
  int count = 0;
  const LambertHit& eye(int i) const { return eyes[items[i < count ? i : 0]]; }
};

LitGroup make_group(const Packet& packet) {
  LitGroup group;
  group.used = group.lambertian = (1u << packet.count) - 1;
  for (int i = 0; i < RayPacket::lanes; i++) {
    const LambertHit& eye = packet.eye(i);
    group.position.set(i, eye.position);
    group.normal.set(i, eye.normal);
    group.face.set(i, eye.face);
    group.origin.set(i, eye.origin);
    group.extent[i] = eye.extent;
  }
  return group;
}

// Gathers what clipping took (gather_rest): few rays meet anything so near, which is tested for all
// rays at once.
void gather_clipped(const EyeLight& light, std::span<const Request> requests, const Packet& packet,
                    const LitGroup& group, LambertLight& sum) {
  constexpr uint32_t direction_dimension = 0, later_dimensions = 1;
  RayPacket rays;
  uint32_t active = 0;
  for (int h = 0; h < GroupLane::halves; h++) {
    SamplerLanes samplers;
    for (int i = 0; i < lane_count; i++) {
      const Request& request = requests[packet.eye(h * lane_count + i).request];
      samplers.set(i, Sampler(request.seed, request.index));
    }
    LambertSurfaceLanes surface;
    surface.position = group.position.half(h);
    surface.geometric_normal = group.face.half(h);
    surface.extent = group.extent.half(h);
    LambertLobeLanes lobes{group.normal.half(h), surface.geometric_normal, {}};
    Lanes u, v;
    samplers.pair(all_lane_bits(direction_dimension), u, v);
    Lanes3 direction = sample_cosine_directions(lobes.normal, u, v);
    active |= negative_lanes(eval_lambert_pdfs(lobes, direction) > Lanes{}) << h * lane_count;
    set_rays(offset_origins(surface, direction), direction, all_lanes(light.pass.clip),
             h * lane_count, rays);
  }
  for (uint32_t near = light.transport.world.occluded_packet(rays, active & group.used); near;
       near &= near - 1) {
    int i = std::countr_zero(near);
    const Request& request = requests[packet.eye(i).request];
    Sampler sampler(request.seed, request.index);
    sampler.seek(later_dimensions);
    Walk walk;
    walk.depth = 2;
    walk.ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
    walk.ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    // The lobe's value over the density of its sampling is its reflectance.
    sum.smooth.set(i, sum.smooth.at(i) + pi * gather_along(light, walk, sampler));
  }
}

}  // namespace

PixelGroup group_of_pixel(const InstantPass& pass, uint32_t pixel) {
  return {region_of_pixel(pass, pixel), list_of_pixel(pass, pixel)};
}

void GroupOrder::add(PixelGroup group, uint32_t item) {
  keys_.push_back(uint64_t(uint32_t(group.region + 1)) << (item_bits + list_bits) |
                  uint64_t(uint32_t(group.list)) << item_bits | item);
}
void GroupOrder::sort() { std::sort(keys_.begin(), keys_.end()); }

size_t GroupOrder::take(size_t begin, size_t most, uint32_t* items, PixelGroup& group) const {
  uint64_t name = keys_[begin] >> item_bits;
  group.region = int(name >> list_bits) - 1;
  group.list = int(name & ((1u << list_bits) - 1));
  size_t count = 0;
  for (; count < most && begin + count < keys_.size(); count++) {
    if (keys_[begin + count] >> item_bits != name) break;
    items[count] = uint32_t(keys_[begin + count] & ((1u << item_bits) - 1));
  }
  return count;
}

std::vector<uint32_t> trace_lambert_hits(const Transport& transport, const InstantPass& pass,
                                         int max_depth, std::span<const Request> requests,
                                         std::span<Sample> samples) {
  LambertHits seen = see_lambert(transport, requests, samples);
  const std::vector<LambertHit>& eyes = seen.eyes;
  GroupOrder order;
  for (size_t i = 0; i < eyes.size(); i++) {
    vec3& albedo = samples[eyes[i].request].albedo;
    if (!(max_component(albedo) > least_albedo)) albedo = vec3(0);
    else order.add(group_of_pixel(pass, requests[eyes[i].request].pixel), uint32_t(i));
  }
  order.sort();
  const bool clipped = pass.compensate && pass.clip > 0 && max_depth > 2;
  for (size_t begin = 0; begin < order.size();) {
    Packet packet;
    packet.eyes = eyes;
    PixelGroup name;
    packet.count = int(order.take(begin, RayPacket::lanes, packet.items, name));
    begin += size_t(packet.count);
    const LitGroup group = make_group(packet);
    LambertLight light{};
    int set = set_of_list(pass, name.list);
    shade_lambert_by_point_lights(transport, pass, {set, 0, 1, 0, name.region, name.list},
                                  max_depth, group, light);
    if (clipped) gather_clipped({transport, pass, max_depth, set}, requests, packet, group, light);
    for (int i = 0; i < packet.count; i++) {
      Sample& sample = samples[packet.eye(i).request];
      sample.smooth += light.smooth.at(i) / pi;
      sample.rest += sample.albedo * light.exact.at(i) / pi;
    }
  }
  return std::move(seen.others);
}

namespace {

// Holds one request on its way.
struct Eye {
  Sampler sampler;
  Sample sample;
  FirstSurface first;
  std::unique_ptr<std::optional<WavelengthSpread>> spread;  // if the surface parts colours
  PixelGroup group;
  DemodulatedReflectance kept;  // without the tint
  PlaceLight light;
};

// Gives the surface a reflectance of 1, so that light is kept apart from what reflects it.
void split_first(Eye& eye) {
  Bsdf& bsdf = eye.first.bsdf;
  eye.kept = demodulated_reflectance(eye.first);
  vec3 a = eye.kept.albedo;
  bool soft = !has_sharp(bsdf, mirror_alpha) && !(max_component(bsdf.transmit) > 0) &&
              std::min({a.x, a.y, a.z}) >= least_demodulated_metal;
  eye.kept.lit_gloss = soft ? 1 : 0;
  eye.sample.albedo = a * eye.first.tint;
  bsdf.diffuse = eye.kept.diffuse ? vec3(1) : vec3(0);
  if (bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f) eye.sample.flags |= sample_specular;
}

// Follows the components of the first scattering, each on its own (section 4: the eye's path is
// split once).
void follow_first(const EyeLight& light, Eye& eye) {
  const Transport& transport = light.transport;
  const FirstSurface& first = eye.first;
  const Bsdf& bsdf = first.bsdf;
  if (!has_sharp(bsdf, mirror_alpha)) return;
  vec3 rest(0);
  if (has_blurred(bsdf))
    rest +=
        sample_direct_light(transport, first.walk, first.surface, bsdf, true, eye.sampler).specular;
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance = has_diffuse(bsdf) ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  if (chance == 1 || eye.sampler.next() < chance) {
    Walk next = first.walk;
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, eye.sampler);
    if (eye.spread) carry_colors(**eye.spread, bsdf, scattered, next);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (scattered.bounce == Bounce::refract) next.density *= bsdf.eta * bsdf.eta;
    if (advance(next, first.surface, scattered)) rest += follow_mirrors(light, next, eye.sampler);
  }
  eye.sample.rest += first.tint * rest;
}

void finish(const EyeLight& light, Eye& eye) {
  if (eye.first.scatters) {
    LitPlace place{&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media, eye.first.walk.depth,
                   mirror_alpha};
    gather_rest(light, place, eye.sampler, eye.light);
    Sample& sample = eye.sample;
    const PlaceLight& got = eye.light;
    const DemodulatedReflectance& kept = eye.kept;
    vec3 albedo = kept.diffuse ? sample.albedo * kept.diffuse_share : vec3(0);
    sample.smooth += kept.diffuse_share * got.diffuse;
    sample.rest += albedo * got.exact_diffuse;
    if (kept.lit_gloss > 0) sample.smooth += got.specular / kept.albedo;
    else sample.rest += eye.first.tint * got.specular;
    sample.rest += eye.first.tint * got.exact_specular;
    follow_first(light, eye);
  }
  if (eye.first.mirrored)
    eye.sample.rest += follow_mirrors(light, eye.first.reflection, eye.sampler);
}

// Answers the requests of those numbers, whatever material they see.
void trace_others(const Transport& transport, const InstantPass& pass, int max_depth,
                  std::span<const Request> requests, std::span<const uint32_t> numbers,
                  std::span<Sample> samples) {
  std::vector<Eye> eyes;
  eyes.reserve(numbers.size());
  GroupOrder order;
  for (size_t i = 0; i < numbers.size(); i++) {
    const Request& request = requests[numbers[i]];
    Eye& eye = eyes.emplace_back(Eye{Sampler(request.seed, request.index), {}, {}, {}, {}, {}, {}});
    eye.group = group_of_pixel(pass, request.pixel);
    if (max_depth < 1) continue;
    eye.first = find_first_surface(transport, max_depth, request, eye.sampler, eye.sample);
    if (!eye.first.scatters) continue;
    if (parts_colors(transport, eye.first.walk.media, eye.first.surface)) {
      eye.spread = std::make_unique<std::optional<WavelengthSpread>>();
      part_seen_colors(transport, eye.first.walk, eye.first.surface, eye.sampler, eye.first.bsdf,
                       *eye.spread);
    }
    split_first(eye);
    order.add(eye.group, uint32_t(i));
  }
  order.sort();
  for (size_t begin = 0; begin < order.size();) {
    LitPlace places[RayPacket::lanes];
    PlaceLight light[RayPacket::lanes];
    uint32_t items[RayPacket::lanes];
    PixelGroup group;
    int count = int(order.take(begin, RayPacket::lanes, items, group));
    begin += size_t(count);
    for (int i = 0; i < count; i++) {
      const Eye& eye = eyes[items[i]];
      places[i] = {&eye.first.surface, &eye.first.bsdf, &eye.first.walk.media, eye.first.walk.depth,
                   mirror_alpha};
    }
    int set = set_of_list(pass, group.list);
    shade_by_point_lights(transport, pass, {set, 0, 1, 0, group.region, group.list}, max_depth,
                          places, count, light);
    if (!pass.photons.empty()) {
      PhotonCells cells;
      for (int i = 0; i < count; i++)
        shade_by_photons(transport, pass.photons[size_t(set)], max_depth, places[i], cells,
                         light[i]);
    }
    for (int i = 0; i < count; i++) eyes[items[i]].light = light[i];
  }
  for (size_t i = 0; i < eyes.size(); i++) {
    if (max_depth >= 1)
      finish({transport, pass, max_depth, set_of_list(pass, eyes[i].group.list)}, eyes[i]);
    samples[numbers[i]] = eyes[i].sample;
  }
}

}  // namespace

void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples) {
  static const InstantPass nothing = [] {
    InstantPass pass;
    pass.first = {0, 0};
    return pass;
  }();
  const InstantPass& pass = lights.pass ? *lights.pass : nothing;
  Transport transport{world, *lights.tables};
  transport.sees_volumes = settings.sees_volumes;
  std::vector<uint32_t> others;
  if (pass.sharp || settings.max_depth < 2) {
    for (size_t i = 0; i < requests.size(); i++) others.push_back(uint32_t(i));
  } else {
    others = trace_lambert_hits(transport, pass, settings.max_depth, requests, samples);
  }
  trace_others(transport, pass, settings.max_depth, requests, others, samples);
  finish_samples(lights, settings, samples);
}

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request) {
  Sample sample;
  trace_many_instant(world, lights, settings, std::span(&request, 1), std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
