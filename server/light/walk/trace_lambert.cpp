// SPDX-License-Identifier: Apache-2.0
// Traces eight samples side by side, each at its own depth, for as long as all that they meet is
// Lambertian: does what shade_first_lambert and scatter_lambert do one by one. Rays are traced one
// by one all the same, because they have nothing in common. A sample that meets anything else goes
// on alone, and the next one takes its lane. Nothing in a lane depends on the others.
#include "light/walk/trace_lambert.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/material/lambert.h"
#include "light/random/sampler.h"
#include "light/walk/first_surface.h"
#include "light/walk/known_light.h"
#include "world/surface.h"
#include "world/world_packet.h"

namespace wellspring::light {
namespace {

// Describes the samples of up to eight requests from number `first` on, those of `lanes`.
void describe_lanes(const Transport& transport, const RayPacket& rays, const Hit* hits,
                    uint32_t lanes, size_t first, std::span<Sample> samples,
                    std::vector<LambertHit>& eyes) {
  Lanes3 direction{load_lanes(rays.direction_x), load_lanes(rays.direction_y),
                   load_lanes(rays.direction_z)};
  LambertSurfaceLanes surface = eval_lambert_surfaces(transport.world, direction, hits, lanes);
  LambertLobeLanes lobes = make_lambert(surface, direction);
  Lanes3 origin = offset_origins(surface, surface.geometric_normal);
  for (uint32_t bits = lanes; bits; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    Sample& sample = samples[first + size_t(i)];
    sample = Sample();
    describe_place(transport.world, hits[i], surface.place(i), surface.normal.at(i), hits[i].t,
                   sample);
    sample.albedo = lobes.reflectance.at(i);
    eyes.push_back({uint32_t(first) + uint32_t(i), surface.position.at(i), lobes.normal.at(i),
                    lobes.geometric_normal.at(i), origin.at(i), surface.extent[i]});
  }
}

}  // namespace

LambertHits see_lambert(const Transport& transport, std::span<const Request> requests,
                        std::span<Sample> samples) {
  LambertHits seen;
  seen.eyes.reserve(requests.size());
  for (size_t first = 0; first < requests.size(); first += lane_count) {
    int count = int(std::min(requests.size() - first, size_t(lane_count)));
    RayPacket rays{};
    Hit hits[RayPacket::lanes];
    uint32_t asked = 0, lambertian = 0;
    for (int i = 0; i < count; i++) {
      const Request& request = requests[first + size_t(i)];
      bool in_solid =
          transport.tables.any_solid && find_media(transport, request.ray.origin).count > 0;
      if (!transport.tables.any_lambertian || in_solid || request.ray.t_min != 0) continue;
      set_ray(request.ray, i, rays);
      asked |= 1u << i;
    }
    transport.world.intersect_each(rays, asked, hits);
    for (int i = 0; i < count; i++) {
      uint32_t number = uint32_t(first) + uint32_t(i);
      const bool sees = transport.sees_volumes && asked >> i & 1 &&
                        transport.world.has_volume_on(requests[number].ray, hits[i].t);
      if (!(asked >> i & 1) || sees) {
        seen.others.push_back(number);
      } else if (!hits[i].valid()) {
        samples[number] = Sample();
        describe_sky(transport, requests[number].ray.direction, vec3(1), samples[number]);
        seen.nothing.push_back(number);
      } else if (met_lambertian(transport, hits[i])) {
        lambertian |= 1u << i;
      } else {
        seen.others.push_back(number);
      }
    }
    if (lambertian) describe_lanes(transport, rays, hits, lambertian, first, samples, seen.eyes);
  }
  return seen;
}

namespace {

struct LambertWalks {
  uint32_t held = 0;  // lanes with a sample at hits[lane], a Lambertian surface
  Hit hits[lane_count];
  size_t sample[lane_count];
  SamplerLanes samplers;
  LaneMask depth{};    // 1: seen by the eye
  uint32_t known = 0;  // lanes whose first surface has light in a map
  KnownLight map[lane_count];
  Lanes3 direction, throughput, smooth, rest;
  // The place that the ray left.
  Lanes3 from, from_normal;
  Lanes pdf{};
  Wavelengths wavelengths[lane_count];
};

struct Batch {
  const Transport& transport;
  const WalkRules& rules;
  std::span<const Request> requests;
  std::span<Sample> samples;
  size_t next = 0;
  bool volumes = !transport.world.volumes().empty();
};

// Returns the dimensions of the surface at that depth, as walk.h numbers them.
LaneBits dimensions_of(LaneMask depth) {
  LaneBits later = Dimensions::walk + LaneBits(depth - 2) * Dimensions::surface;
  return depth == 1 ? all_lane_bits(uint32_t(Dimensions::first_surface)) : later;
}

template <class Body>
void for_each_lane(uint32_t lanes, const Body& body) {
  for (; lanes; lanes &= lanes - 1) body(std::countr_zero(lanes));
}

// Returns whether the sample that the eye's ray belongs to begins on something Lambertian; else it
// is answered.
bool begins_lambertian(Batch& batch, int lane, LambertWalks& walks) {
  const Transport& transport = batch.transport;
  const Request& request = batch.requests[walks.sample[lane]];
  Sample& sample = batch.samples[walks.sample[lane]];
  Hit& hit = walks.hits[lane];
  if (request.ray.t_min != 0) hit = transport.world.intersect(request.ray);  // not in packets
  bool in_solid = transport.tables.any_solid && find_media(transport, request.ray.origin).count > 0;
  if (!hit.valid() || in_solid || !met_lambertian(transport, hit)) {
    sample = trace_sample(transport, batch.rules, request, hit);
    return false;
  }
  if (batch.rules.reads_maps && has_known_light(transport, request.ray, hit)) {
    sample = trace_sample(transport, batch.rules, request, hit);
    return false;
  }
  sample = Sample();
  if (transport.sees_volumes &&
      see_volume(transport, begin_walk(transport, request), hit.t, vec3(1), 0, sample))
    return false;
  KnownLight& known = walks.map[lane];
  known = find_known_light(transport, request.ray, hit,
                           request.ray.origin + hit.t * request.ray.direction);
  walks.known = (walks.known & ~(1u << lane)) | uint32_t(known.known) << lane;
  walks.samplers.set(lane, Sampler(request.seed, request.index));
  walks.depth[lane] = 1;
  if (transport.tables.spectral) walks.wavelengths[lane] = Wavelengths();
  walks.direction.set(lane, request.ray.direction);
  walks.throughput.set(lane, vec3(1));
  walks.smooth.set(lane, vec3(0));
  walks.rest.set(lane, sample.rest);  // volumes that glow before it
  return true;
}

// Gives each of those lanes the next sample that begins on something Lambertian; samples before it
// are answered on the way.
void fill_lanes(Batch& batch, uint32_t lanes, RayPacket& rays, LambertWalks& walks) {
  while (lanes && batch.next < batch.requests.size()) {
    uint32_t asking = 0;
    for_each_lane(lanes, [&](int i) {
      if (batch.next == batch.requests.size()) return;
      walks.sample[i] = batch.next++;
      set_ray(batch.requests[walks.sample[i]].ray, i, rays);
      asking |= 1u << i;
    });
    batch.transport.world.intersect_each(rays, asking, walks.hits);
    for_each_lane(asking, [&](int i) {
      if (!begins_lambertian(batch, i, walks)) return;
      walks.held |= 1u << i;
      lanes &= ~(1u << i);
    });
  }
}

void end_walk(Batch& batch, int lane, LambertWalks& walks) {
  Sample& sample = batch.samples[walks.sample[lane]];
  sample.smooth = walks.smooth.at(lane);
  sample.rest = walks.rest.at(lane);
  if (walks.known >> lane & 1) tell_in_units(walks.map[lane], sample.smooth, sample);
  walks.held &= ~(1u << lane);
}

struct DirectLanes {
  Lanes3 area, punctual;
};

// Does what sample_direct_light does if there is one punctual light and no other.
DirectLanes light_by_lamp(const Transport& transport, const LambertSurfaceLanes& surface,
                          const LambertLobeLanes& lobes, uint32_t lanes, RayPacket& rays) {
  const PunctualLight& lamp = transport.tables.punctual[0];
  const SpotCone& cone = transport.tables.cones[0];
  const bool near = lamp.type != PunctualType::directional;
  const Lanes zero{}, one = all_lanes(1.0f);
  Lanes3 way = all_lanes(-lamp.direction);
  Lanes strength = one;
  if (near) {
    Lanes3 line = all_lanes(lamp.position) - surface.position;
    Lanes distance2 = dot(line, line);
    way = line * (one / lanes_sqrt(distance2));
    strength = one / distance2;
    if (std::isfinite(lamp.range) && lamp.range > 0) {
      Lanes ratio2 = distance2 * (1 / (lamp.range * lamp.range));
      strength *= lanes_max(1 - ratio2 * ratio2, zero);
    }
    if (lamp.type == PunctualType::spot) {
      Lanes cosine = -dot(way, all_lanes(lamp.direction));
      Lanes t = lanes_min(lanes_max((cosine - cone.outer) * cone.scale, zero), one);
      strength *= t * t;
    }
    LaneMask usual = (distance2 > 1e-20f) & (distance2 < 3e38f);
    strength = usual ? strength : zero;
  }
  Lanes effect = strength * eval_lambert_pdfs(lobes, way);
  lanes &= negative_lanes(effect > zero);
  Lanes3 origin = offset_origins(surface, way);
  uint32_t seen = 0;
  if (near) {
    Lanes3 line = all_lanes(lamp.position) - origin;
    seen = lanes & ~negative_lanes(dot(line, way) > zero);  // nothing fits in between
    set_rays(origin, line, one, 0, rays);
  } else {
    set_rays(origin, way, all_lanes(std::numeric_limits<float>::infinity()), 0, rays);
  }
  DirectLanes direct;
  Lanes3 light = all_lanes(lamp.intensity) * effect;
  if (!transport.tables.any_pane) {
    seen |= (lanes & ~seen) & ~transport.world.occluded_each(rays, lanes & ~seen);
  } else {
    for_each_lane(lanes & ~seen, [&](int i) {
      LightSample to;
      to.direction = way.at(i);
      to.target = lamp.position;
      if (near) to.distance = length(lamp.position - surface.position.at(i));
      vec3 arrives = eval_visibility(transport, surface.place(i), to);
      light.set(i, light.at(i) * arrives);
      seen |= 1u << i;
    });
  }
  direct.punctual = choose(lanes_of_bits(seen), light, Lanes3{});
  return direct;
}

DirectLanes light_by_choice(const Batch& batch, const LambertSurfaceLanes& surface,
                            const LambertLobeLanes& lobes, const LambertWalks& walks,
                            LaneBits dimensions, uint32_t lanes) {
  DirectLanes direct;
  Walk in_air{};
  for_each_lane(lanes, [&](int i) {
    if (batch.transport.tables.spectral) in_air.wavelengths = walks.wavelengths[i];
    Sampler sampler = walks.samplers.at(i);
    sampler.seek(dimensions[i]);
    const bool first = walks.depth[i] == 1;
    DirectLight one =
        sample_direct_light(batch.transport, in_air, surface.place(i), lobes.at(i), first, sampler);
    direct.area.set(i, one.area_diffuse);
    direct.punctual.set(i, one.punctual_diffuse);
    if (first && !one.sure_of_punctual())
      batch.samples[walks.sample[i]].flags &= uint8_t(~sample_sure);
  });
  return direct;
}

// Tells the lanes' wavelengths of the surfaces that they have arrived at.
void reflect_lanes(const Transport& transport, LaneBits dimensions, uint32_t lanes,
                   LambertWalks& walks) {
  for_each_lane(lanes, [&](int i) {
    Sampler sampler = walks.samplers.at(i);
    reflect(transport, walks.hits[i], dimensions[i], sampler, walks.wavelengths[i]);
  });
}

// Puts the lanes' tints on light of a lamp.
void tint_lanes(const Transport& transport, const LambertWalks& walks, uint32_t lanes, int lamp,
                Lanes3& light) {
  for_each_lane(lanes, [&](int i) {
    if (walks.wavelengths[i].in_color()) return;
    light.set(i, light.at(i) * tint_of(*transport.tables.spectral, walks.wavelengths[i], lamp));
  });
}

// Shades the surfaces that the lanes have arrived at, and sends the lanes on; returns those that
// go.
uint32_t scatter_lanes(Batch& batch, LambertWalks& walks, RayPacket& rays) {
  const Transport& transport = batch.transport;
  const LightTables& tables = transport.tables;
  const Lanes zero{};
  LambertSurfaceLanes surface =
      eval_lambert_surfaces(transport.world, walks.direction, walks.hits, walks.held);
  LambertLobeLanes lobes = make_lambert(surface, walks.direction);
  const LaneMask first = walks.depth == 1;
  const uint32_t first_bits = negative_lanes(first) & walks.held;
  Lanes least = first ? all_lanes(least_albedo) : zero;
  uint32_t lanes = walks.held & negative_lanes(max_component(lobes.reflectance) > least);
  if (batch.rules.max_depth < 2) lanes &= ~first_bits;
  for_each_lane(first_bits, [&](int i) {
    Sample& sample = batch.samples[walks.sample[i]];
    describe_place(transport.world, walks.hits[i], surface.place(i), surface.normal.at(i),
                   walks.hits[i].t, sample);
    sample.flags |= sample_sure;
    if (lanes >> i & 1) sample.albedo = lobes.reflectance.at(i);
  });
  const LaneBits dimensions = dimensions_of(walks.depth);
  const bool one_lamp = tables.punctual.size() == 1 && tables.area_share <= 0;
  if (tables.spectral) reflect_lanes(transport, dimensions, lanes, walks);
  DirectLanes direct = one_lamp ? light_by_lamp(transport, surface, lobes, lanes, rays)
                                : light_by_choice(batch, surface, lobes, walks, dimensions, lanes);
  if (tables.spectral && one_lamp)
    tint_lanes(transport, walks, lanes, tables.punctual[0].spectrum, direct.punctual);
  const LaneMask lit = lanes_of_bits(lanes);
  Lanes3 later = walks.throughput * lobes.reflectance * (direct.area + direct.punctual);
  const LaneMask known = lanes_of_bits(walks.known);
  Lanes3 seen = direct.area + choose(known, direct.punctual, Lanes3{});
  walks.smooth = walks.smooth + choose(lit, choose(first, seen, later), Lanes3{});
  walks.rest =
      walks.rest + choose(lit & first & ~known, lobes.reflectance * direct.punctual, Lanes3{});

  Lanes u, v;
  walks.samplers.pair(dimensions + (Dimensions::scatter + 1), u, v);
  walks.direction = sample_cosine_directions(lobes.normal, u, v);
  walks.pdf = eval_lambert_pdfs(lobes, walks.direction);
  walks.from = surface.position;
  walks.from_normal = surface.geometric_normal;
  walks.throughput = choose(first, walks.throughput, walks.throughput * lobes.reflectance);
  walks.depth += 1;
  set_rays(offset_origins(surface, walks.direction), walks.direction,
           all_lanes(std::numeric_limits<float>::infinity()), 0, rays);
  // Plays Russian roulette as survives() does.
  Lanes largest = max_component(walks.throughput);
  lanes &= negative_lanes((walks.pdf > zero) & (largest > zero));
  LaneMask doubtful = walks.depth > roulette_depth;
  if (negative_lanes(doubtful) & lanes) {
    Lanes chance = lanes_min(all_lanes(0.95f), largest);
    Lanes number = walks.samplers.number(dimensions + uint32_t(Dimensions::survival));
    lanes &= ~negative_lanes(doubtful & (number >= chance));
    walks.throughput = walks.throughput * (1 / (doubtful ? chance : all_lanes(1.0f)));
  }
  return lanes;
}

Walk lone_walk(const LightTables& tables, const LambertWalks& walks, const RayPacket& rays, int i) {
  Walk walk;
  walk.ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
  walk.ray.direction = walks.direction.at(i);
  walk.throughput = walks.throughput.at(i);
  walk.depth = walks.depth[i];
  walk.pdf = walks.pdf[i];
  walk.from = walks.from.at(i);
  walk.from_normal = walks.from_normal.at(i);
  // At the first surface both kinds of light are sampled.
  walk.area_share = walk.depth > 2 || tables.area_share <= 0 ? tables.area_share : 1;
  walk.scattered = walk.depth - 1;
  if (tables.spectral) walk.wavelengths = walks.wavelengths[i];
  return walk;
}

// Returns whether the lane's sample has arrived at the next Lambertian surface; else it is
// answered.
bool goes_on(Batch& batch, const RayPacket& rays, int i, bool sky, LambertWalks& walks) {
  const Transport& transport = batch.transport;
  const Hit& hit = walks.hits[i];
  const bool lambertian = hit.valid() && met_lambertian(transport, hit);
  if ((!hit.valid() && !sky) || (lambertian && !transport.known)) {
    if (batch.volumes) {
      vec3 more(0);
      const Walk walk = lone_walk(transport.tables, walks, rays, i);
      const bool ends = ends_in_volume(transport, walk, hit.t, more);
      walks.smooth.set(i, walks.smooth.at(i) + more);
      if (ends) return false;
    }
    return lambertian && walks.depth[i] <= batch.rules.scatterings &&
           walks.depth[i] < batch.rules.max_depth;
  }
  Sampler sampler = walks.samplers.at(i);
  sampler.seek(dimensions_of(walks.depth)[i]);
  Walk walk = lone_walk(transport.tables, walks, rays, i);
  vec3 more = follow(transport, batch.rules, walk, hit, sampler);
  walks.smooth.set(i, walks.smooth.at(i) + more);
  return false;
}

}  // namespace

void trace_samples(const Transport& transport, const WalkRules& rules,
                   std::span<const Request> requests, std::span<Sample> samples) {
  if (!transport.tables.any_lambertian || rules.max_depth < 1) {
    for (size_t i = 0; i < requests.size(); i++)
      samples[i] = trace_sample(transport, rules, requests[i]);
    return;
  }
  Batch batch{transport, rules, requests, samples};
  const bool sky = transport.tables.plan.uses(TransportPart::environment);
  RayPacket rays{};
  LambertWalks walks;
  fill_lanes(batch, (1u << lane_count) - 1, rays, walks);
  while (walks.held) {
    uint32_t going = scatter_lanes(batch, walks, rays), arrived = 0;
    transport.world.intersect_each(rays, going, walks.hits);
    for_each_lane(going,
                  [&](int i) { arrived |= uint32_t(goes_on(batch, rays, i, sky, walks)) << i; });
    const uint32_t ended = walks.held & ~arrived;
    for_each_lane(ended, [&](int i) { end_walk(batch, i, walks); });
    fill_lanes(batch, ended, rays, walks);
  }
}

}  // namespace wellspring::light
