// SPDX-License-Identifier: Apache-2.0
#include "light/instant/instant_lambert.h"

#include <algorithm>
#include <bit>

#include "light/instant/eye_light.h"
#include "light/walk/first_surface.h"
#include "light/walk/lambert_hits.h"
#include "light/material/lambert_simd.h"
#include "light/random/sampler_simd.h"
#include "world/packet_simd.h"

namespace wellspring::light {
namespace {

constexpr int item_bits = 22, list_bits = 10;

// Up to 16 eyes of one group.
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

// What clipping took (gather_rest): few rays meet anything so near, which is asked of all at once.
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

}  // namespace wellspring::light
