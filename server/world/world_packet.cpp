// SPDX-License-Identifier: Apache-2.0
// Traces rays side by side. Each lane's answer is its own, whatever the other lanes hold.
#include "world/world_packet.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "base/simd.h"
#include "world/world_impl.h"

namespace wellspring::world {
namespace {

// Returns the widest packets that the machine traces natively.
int packet_width() {
  static int width = [] {
    RTCDevice device = shared_device();
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    return rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 1;
  }();
  return width;
}

constexpr float farthest = 1e17f;  // Embree's places end at 1.84e18

// Returns the bits of `active` whose rays are finite and have a length.
uint32_t traceable(const RayPacket& p, uint32_t active) {
  uint32_t good = 0;
  for (int i = 0; i < RayPacket::lanes; i += lane_count) {
    if (!(active >> i & 0xff)) continue;
    auto size = [&](const float* x, const float* y, const float* z) {
      return lanes_abs(load_lanes(x + i)) + lanes_abs(load_lanes(y + i)) +
             lanes_abs(load_lanes(z + i));
    };
    LaneMask fine = (size(p.origin_x, p.origin_y, p.origin_z) <= farthest) &
                    (size(p.direction_x, p.direction_y, p.direction_z) <= farthest) &
                    (load_lanes(p.t_max + i) >= 0);
    good |= negative_lanes(fine) << i;
  }
  return active & good;
}

// Returns the bits of `active` whose rays meet the box.
uint32_t meeting(const Bounds& box, const RayPacket& p, uint32_t active) {
  if (!(box.low.x <= box.high.x)) return 0;
  float near[RayPacket::lanes], far[RayPacket::lanes];
  for (int i = 0; i < RayPacket::lanes; i++) near[i] = 0, far[i] = p.t_max[i];
  auto cut = [&](const float* origin, const float* direction, float low, float high) {
    for (int i = 0; i < RayPacket::lanes; i++)
      cut_by_slab(low, high, origin[i], 1 / direction[i], near[i], far[i]);
  };
  cut(p.origin_x, p.direction_x, box.low.x, box.high.x);
  cut(p.origin_y, p.direction_y, box.low.y, box.high.y);
  cut(p.origin_z, p.direction_z, box.low.z, box.high.z);
  uint32_t met = 0;
  for (int i = 0; i < RayPacket::lanes; i++) met |= uint32_t(near[i] <= far[i] * 1.00001f) << i;
  return active & met;
}

}  // namespace

template <class Lanes, int width>
uint32_t World::Impl::occluded_lanes(const RayPacket& p, uint32_t active, int first) const {
  constexpr size_t bytes = size_t(width) * sizeof(float);
  alignas(64) int valid[width];
  Lanes r;
  std::memcpy(r.org_x, p.origin_x + first, bytes);
  std::memcpy(r.org_y, p.origin_y + first, bytes);
  std::memcpy(r.org_z, p.origin_z + first, bytes);
  std::memcpy(r.dir_x, p.direction_x + first, bytes);
  std::memcpy(r.dir_y, p.direction_y + first, bytes);
  std::memcpy(r.dir_z, p.direction_z + first, bytes);
  std::memcpy(r.tfar, p.t_max + first, bytes);
  for (int i = 0; i < width; i++) {
    valid[i] = active >> (first + i) & 1 ? -1 : 0;
    r.tnear[i] = 0, r.time[i] = 0, r.mask[i] = ~0u, r.id[i] = unsigned(first + i), r.flags[i] = 0;
  }
  Query query;
  embree::init(query);
  query.packet = &p;
  auto blocked = [&] {
    uint32_t bits = 0;
    for (int i = 0; i < width; i++) bits |= uint32_t(r.tfar[i] < 0) << (first + i);
    return bits & active;
  };
  embree::occluded(still_scene, query, valid, r);
  uint32_t still = blocked();
  uint32_t left = meeting(moving_bounds, p, active & ~still);
  if (left == 0) return still;
  for (int i = 0; i < width; i++) valid[i] = left >> (first + i) & 1 ? -1 : 0;
  embree::occluded(moving_scene, query, valid, r);
  return blocked();
}

uint32_t World::occluded_packet(const RayPacket& rays, uint32_t active) const {
  active = traceable(rays, active);
  if (active == 0) return 0;
  const Impl& w = *impl_;
  uint32_t blocked = 0;
  if (packet_width() == 16) {
    blocked = w.occluded_lanes<RTCRay16, 16>(rays, active, 0);
  } else if (packet_width() == 8) {
    if (active & 0xff) blocked |= w.occluded_lanes<RTCRay8, 8>(rays, active & 0xff, 0);
    if (active >> 8) blocked |= w.occluded_lanes<RTCRay8, 8>(rays, active & 0xff00, 8);
  } else {
    Impl::Query query;
    query.packet = &rays;
    for (unsigned i = 0; i < RayPacket::lanes; i++)
      if (active >> i & 1) blocked |= uint32_t(w.is_occluded(query.ray(i), nullptr)) << i;
  }
  return blocked | w.shaded(rays, active & ~blocked);
}

namespace {

RTCRay lone_ray() {
  RTCRay r;
  r.tnear = 0, r.time = 0, r.mask = ~0u, r.flags = 0;
  return r;
}

inline void set_ray(const RayPacket& p, int i, RTCRay& r) {
  r.org_x = p.origin_x[i], r.org_y = p.origin_y[i], r.org_z = p.origin_z[i];
  r.dir_x = p.direction_x[i], r.dir_y = p.direction_y[i], r.dir_z = p.direction_z[i];
  r.tfar = p.t_max[i], r.id = unsigned(i);
}

}  // namespace

void World::intersect_each(const RayPacket& p, uint32_t active, Hit* hits) const {
  const Impl& w = *impl_;
  const uint32_t asked = active;
  active = traceable(p, asked);
  for (uint32_t bits = asked & ~active; bits; bits &= bits - 1)
    hits[std::countr_zero(bits)] = Hit();
  uint32_t moving = w.any_moving ? meeting(w.moving_bounds, p, active) : 0;
  Impl::Query query;
  embree::init(query);
  query.packet = &p;
  RTCRayHit r;
  r.ray = lone_ray();
  auto ask = [&](RTCScene scene) {
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(scene, query, r);
  };
  auto hit = [&](bool is_moving) {
    return w.to_hit(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.hit.u, r.hit.v, r.ray.tfar,
                    is_moving);
  };
  for (uint32_t bits = active; bits; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    set_ray(p, i, r.ray);
    ask(w.still_scene);
    hits[i] = hit(false);
    if (!(moving >> i & 1)) continue;
    ask(w.moving_scene);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) hits[i] = hit(true);
  }
  for (uint32_t bits = active & p.from_eye; bits; bits &= bits - 1) {
    const int i = std::countr_zero(bits);
    hits[i] = w.seen(query.ray(unsigned(i)), hits[i]);
  }
  count_rays(uint64_t(std::popcount(active)));
}

uint32_t World::occluded_each(const RayPacket& p, uint32_t active) const {
  const Impl& w = *impl_;
  active = traceable(p, active);
  uint32_t moving = w.any_moving ? meeting(w.moving_bounds, p, active) : 0, blocked = 0;
  Impl::Query query;
  embree::init(query);
  query.packet = &p;
  RTCRay r = lone_ray();
  for (uint32_t bits = active; bits; bits &= bits - 1) {
    int i = std::countr_zero(bits);
    set_ray(p, i, r);
    embree::occluded1(w.still_scene, query, r);
    if (!(r.tfar < 0) && (moving >> i & 1)) embree::occluded1(w.moving_scene, query, r);
    blocked |= uint32_t(r.tfar < 0) << i;
  }
  count_rays(uint64_t(std::popcount(active)));
  return blocked | w.shaded(p, active & ~blocked);
}

}  // namespace wellspring::world
