// SPDX-License-Identifier: Apache-2.0
#include "light/instant/lit_group.h"

#include <bit>
#include <cmath>

#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "world/packet_simd.h"

namespace wellspring::light {
namespace {

constexpr int halves = GroupLane::halves;
constexpr float infinity = std::numeric_limits<float>::infinity();

// From a target to every lane's surface.
void aim(const LitGroup& group, vec3 target, RayPacket& rays) {
  const Lanes3 from = all_lanes(target);
  for (int h = 0; h < halves; h++)
    set_rays(from, group.origin.half(h) - from, all_lanes(1.0f), h * lane_count, rays);
}

// Those that light reaches on the other side of their surface, or from the other side of the light.
void aim_lane(const LitGroup& group, vec3 target, const SeenLight& seen, int i, RayPacket& rays) {
  vec3 way = offset_origin(group.place(i), seen.direction.at(i)) - target;
  rays.origin_x[i] = target.x, rays.origin_y[i] = target.y, rays.origin_z[i] = target.z;
  rays.direction_x[i] = way.x, rays.direction_y[i] = way.y, rays.direction_z[i] = way.z;
}

void see_area(const LitGroup& group, const PointLight& light, float clip2, SeenLight& seen) {
  uint32_t lit = 0, back = 0;
  const Lanes3 place = all_lanes(light.position), emits = all_lanes(light.normal);
  const Lanes most = all_lanes(clip2 > 0 ? 1 / clip2 : infinity), zero{};
  for (int h = 0; h < halves; h++) {
    Lanes3 way = place - group.position.half(h);
    Lanes distance2 = dot(way, way);
    Lanes inverse = 1 / lanes_sqrt(lanes_max(distance2, all_lanes(1e-30f)));
    Lanes here = dot(group.normal.half(h), way) * inverse, face = dot(group.face.half(h), way);
    Lanes there = -dot(emits, way) * inverse;
    seen.direction.set_half(h, way);
    seen.distance2.set_half(h, distance2);
    seen.cosine.set_half(h, here);
    seen.strength.set_half(h, lanes_abs(there) * lanes_min(inverse * inverse, most));
    lit |= negative_lanes((distance2 > 1e-20f) & (here > zero) & (face > zero) & (there != zero))
           << h * lane_count;
    back |= negative_lanes(there < zero) << h * lane_count;
  }
  seen.active = lit | group.through;
  if (!light.double_sided) seen.active &= ~back;
  seen.active &= group.used;
  if (seen.active == 0) return;
  aim(group, light.target, seen.rays);
  for (uint32_t odd = seen.active & (group.through | (light.double_sided ? back : 0)); odd;
       odd &= odd - 1) {
    int i = std::countr_zero(odd);
    vec3 other_side = 2.0f * light.position - light.target;
    aim_lane(group, back >> i & 1 ? other_side : light.target, seen, i, seen.rays);
  }
}

void see_distant(const LitGroup& group, vec3 direction, SeenLight& seen) {
  uint32_t lit = 0;
  const Lanes3 way = all_lanes(direction);
  const Lanes zero{};
  for (int h = 0; h < halves; h++) {
    Lanes here = dot(group.normal.half(h), way), face = dot(group.face.half(h), way);
    seen.direction.set_half(h, way);
    seen.distance2.set_half(h, all_lanes(1.0f));
    seen.cosine.set_half(h, here);
    seen.strength.set_half(h, all_lanes(1.0f));
    lit |= negative_lanes((here > zero) & (face > zero)) << h * lane_count;
    set_rays(group.origin.half(h), way, all_lanes(infinity), h * lane_count, seen.rays);
  }
  seen.active = (lit | group.through) & group.used;
  for (uint32_t odd = seen.active & group.through; odd; odd &= odd - 1) {
    int i = std::countr_zero(odd);
    vec3 origin = offset_origin(group.place(i), direction);
    seen.rays.origin_x[i] = origin.x, seen.rays.origin_y[i] = origin.y;
    seen.rays.origin_z[i] = origin.z;
  }
}

// Colours differ by direction only in strength.
void see_punctual(const LightTables& tables, const LitGroup& group, size_t index, SeenLight& seen) {
  const PunctualLight& punctual = tables.punctual[index];
  if (punctual.type == PunctualType::directional)
    return see_distant(group, -punctual.direction, seen);
  const SpotCone& cone = tables.cones[index];
  const bool spot = punctual.type == PunctualType::spot,
             ends = std::isfinite(punctual.range) && punctual.range > 0;
  const Lanes3 place = all_lanes(punctual.position), axis = all_lanes(punctual.direction);
  const Lanes zero{}, one = all_lanes(1.0f);
  uint32_t lit = 0;
  for (int h = 0; h < halves; h++) {
    Lanes3 way = place - group.position.half(h);
    Lanes distance2 = dot(way, way);
    Lanes inverse = 1 / lanes_sqrt(lanes_max(distance2, all_lanes(1e-30f)));
    Lanes strength = 1 / lanes_max(distance2, all_lanes(1e-20f));
    if (spot) {
      Lanes t = (-dot(way, axis) * inverse - cone.outer) * cone.scale;
      t = lanes_min(lanes_max(t, zero), one);
      strength *= t * t;
    }
    if (ends) {  // range_window
      Lanes ratio2 = distance2 * (1 / (punctual.range * punctual.range));
      strength *= lanes_max(1 - ratio2 * ratio2, zero);
    }
    Lanes here = dot(group.normal.half(h), way) * inverse;
    seen.direction.set_half(h, way);
    seen.distance2.set_half(h, distance2);
    seen.cosine.set_half(h, here);
    seen.strength.set_half(h, strength);
    LaneMask through = lanes_of_bits(group.through >> h * lane_count & 0xff);
    LaneMask faces = (here > zero) & (dot(group.face.half(h), way) > zero);
    lit |= negative_lanes((distance2 > 1e-20f) & (strength > zero) & (through | faces))
           << h * lane_count;
  }
  seen.active = lit & group.used;
  if (seen.active == 0) return;
  aim(group, punctual.position, seen.rays);
  for (uint32_t odd = seen.active & group.through; odd; odd &= odd - 1)
    aim_lane(group, punctual.position, seen, std::countr_zero(odd), seen.rays);
}

}  // namespace

void see_light(const LightTables& tables, const LitGroup& group, const PointLight& light,
               float clip2, SeenLight& seen, vec3& radiance) {
  radiance = light.radiance;
  if (light.kind == PointLightKind::distant) return see_distant(group, light.position, seen);
  if (light.kind != PointLightKind::punctual) return see_area(group, light, clip2, seen);
  see_punctual(tables, group, light.index, seen);
  radiance *= tables.punctual[light.index].intensity;
}

}  // namespace wellspring::light
