// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/point_light_shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "light/sample/sample_light.h"
#include "light/walk/walk.h"
#include "world/world_packet.h"

namespace wellspring::light {
namespace {

constexpr int halves = GroupLane::halves;
constexpr float infinity = std::numeric_limits<float>::infinity();

// Aims rays from a target at every lane's surface.
void aim(const LitGroup& group, vec3 target, RayPacket& rays) {
  const Lanes3 from = all_lanes(target);
  for (int h = 0; h < halves; h++)
    set_rays(from, group.origin.half(h) - from, all_lanes(1.0f), h * lane_count, rays);
}

// Aims the ray of a lane that light reaches on the other side of its surface, or from the other
// side of the light.
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

// Sees a punctual light, whose colours differ by direction only in strength.
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
    if (ends) {  // as range_window() does
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

namespace {

constexpr int lanes = RayPacket::lanes;

LitGroup make_group(const LitPlace* places, int count) {
  LitGroup group{};
  for (int i = 0; i < lanes; i++) {
    const LitPlace& place = places[i < count ? i : 0];
    const Bsdf& bsdf = *place.bsdf;
    group.position.set(i, place.surface->position);
    group.origin.set(i, offset_origin(*place.surface, place.surface->geometric_normal));
    group.normal.set(i, bsdf.normal);
    group.face.set(i, bsdf.geometric_normal);
    group.extent[i] = place.surface->extent;
    if (i >= count) continue;
    group.used |= 1u << i;
    bool plain = place.media->here.count == 0 && place.hue() < 0;
    if (!has_specular(bsdf) && plain) group.lambertian |= 1u << i;
    if (max_component(bsdf.transmit) > 0 && smoothest_alpha(bsdf) >= place.sharp)
      group.through |= 1u << i;
  }
  return group;
}

void add_lane(const Transport& transport, const LitPlace& place, const PointLight& light,
              const InstantPass& pass, const SeenLight& seen, vec3 radiance, int i,
              PlaceLight& sum) {
  if (light.hue >= 0) radiance *= meet_hues(*transport.tables.spectral, place.hue(), light.hue);
  float distance = std::sqrt(seen.distance2[i]);
  vec3 direction = seen.direction.at(i) / distance;
  BsdfValue value = eval_bsdf(*place.bsdf, direction);
  if (has_sharp(*place.bsdf, place.sharp)) value.specular = vec3(0);
  if (!(max_component(value.diffuse + value.specular) > 0)) return;
  if (light.kind == PointLightKind::scattering)
    radiance *= eval_scattered(pass.arrivals[light.index], -direction) /
                std::max(seen.distance2[i], pass.clip * pass.clip);
  else radiance *= seen.strength[i];
  if (transport.tables.any_tint)
    radiance *= eval_absorption(
        transport, medium_towards(*place.media, *place.surface, direction),
        std::isfinite(seen.rays.t_max[i]) ? distance : std::numeric_limits<float>::infinity());
  (light.exact ? sum.exact_diffuse : sum.diffuse) += value.diffuse * radiance;
  (light.exact ? sum.exact_specular : sum.specular) += value.specular * radiance;
}

// Adds a light to Lambertian lanes.
void add_lambert_lanes(const PointLight& light, const InstantPass& pass, const SeenLight& seen,
                       vec3 radiance, uint32_t clear, LambertLight& sum) {
  GroupLane3& to = light.exact ? sum.exact : sum.smooth;
  if (light.kind == PointLightKind::scattering) {
    for (; clear; clear &= clear - 1) {
      int i = std::countr_zero(clear);
      vec3 direction = seen.direction.at(i) / std::sqrt(seen.distance2[i]);
      vec3 leaves = eval_scattered(pass.arrivals[light.index], -direction) /
                    std::max(seen.distance2[i], pass.clip * pass.clip);
      to.set(i, to.at(i) + radiance * leaves * seen.cosine[i]);
    }
    return;
  }
  const Lanes3 color = all_lanes(radiance);
  for (int h = 0; h < GroupLane::halves; h++) {
    Lanes arrives = seen.strength.half(h) * seen.cosine.half(h);
    arrives = lanes_of_bits(clear >> h * lane_count & 0xff) ? arrives : Lanes{};
    to.set_half(h, to.half(h) + color * arrives);
  }
}

// Calls visit(light, factor) for every light that is asked.
template <class Visit>
void for_each_asked(const InstantPass& pass, const SetShare& choice, const Visit& visit) {
  for (const RegionLight& one : choice.few) visit(pass.lights[one.light], one.factor);
  if (!choice.few.empty()) return;
  bool numbered = choice.end != 0;
  uint32_t end = numbered ? choice.end : pass.first[size_t(choice.set) + 1],
           begin = numbered ? choice.start : pass.first[size_t(choice.set)];
  if (choice.region < 0) {
    if (!numbered) begin += choice.start;
    for (uint32_t k = begin; k < end; k += choice.step) visit(pass.lights[k], float(choice.step));
    return;
  }
  for (uint32_t k = begin; k < end && pass.lights[k].depth == 0; k++)
    if (pass.lights[k].exact) visit(pass.lights[k], 1.0f);
  size_t cell = size_t(choice.region) * size_t(pass.lists()) + size_t(choice.list);
  const RegionLights& regions = pass.regions;
  for (uint32_t k = regions.first[cell]; k < regions.first[cell + 1]; k++)
    visit(pass.lights[regions.lights[k].light], regions.lights[k].factor);
}

}  // namespace

void shade_by_point_lights(const Transport& transport, const InstantPass& pass,
                           const SetShare& choice, int max_depth, const LitPlace* places, int count,
                           PlaceLight* light) {
  const LitGroup group = make_group(places, count);
  int deepest = 0;
  for (int i = 0; i < count; i++) deepest = std::max(deepest, max_depth - 1 - places[i].depth);
  float clip2 = pass.clip * pass.clip;
  SeenLight seen;
  LambertLight sum{};
  for_each_asked(pass, choice, [&](const PointLight& source, float factor) {
    if (source.depth > deepest) return;
    vec3 radiance;
    see_light(transport.tables, group, source, clip2, seen, radiance);
    radiance *= factor;
    for (int i = 0; i < count; i++)
      if (places[i].depth + 1 + int(source.depth) > max_depth) seen.active &= ~(1u << i);
    if (seen.active == 0) return;
    uint32_t blocked = choice.few.empty() ? transport.world.occluded_packet(seen.rays, seen.active)
                                          : transport.world.occluded_each(seen.rays, seen.active);
    uint32_t clear = seen.active & ~blocked;
    if (clear & group.lambertian)
      add_lambert_lanes(source, pass, seen, radiance, clear & group.lambertian, sum);
    for (uint32_t slow = clear & ~group.lambertian; slow; slow &= slow - 1) {
      int i = std::countr_zero(slow);
      add_lane(transport, places[i], source, pass, seen, radiance, i, light[i]);
    }
    if (!transport.tables.any_pane) return;
    for (; blocked; blocked &= blocked - 1) {
      int i = std::countr_zero(blocked);
      vec3 tint = eval_blocked(transport, seen.rays, i);
      if (max_component(tint) > 0)
        add_lane(transport, places[i], source, pass, seen, radiance * tint, i, light[i]);
    }
  });
  for (int i = 0; i < count; i++) {
    if (!(group.lambertian >> i & 1)) continue;
    vec3 value = places[i].bsdf->diffuse / pi;
    light[i].diffuse += sum.smooth.at(i) * value;
    light[i].exact_diffuse += sum.exact.at(i) * value;
  }
}

void shade_lambert_by_point_lights(const Transport& transport, const InstantPass& pass,
                                   const SetShare& choice, int max_depth, const LitGroup& group,
                                   LambertLight& sum) {
  float clip2 = pass.clip * pass.clip;
  SeenLight seen;
  for_each_asked(pass, choice, [&](const PointLight& source, float factor) {
    if (source.depth > max_depth - 2) return;
    vec3 radiance;
    see_light(transport.tables, group, source, clip2, seen, radiance);
    if (seen.active == 0) return;
    radiance *= factor;
    uint32_t blocked = transport.world.occluded_packet(seen.rays, seen.active);
    add_lambert_lanes(source, pass, seen, radiance, seen.active & ~blocked, sum);
    if (!transport.tables.any_pane) return;
    for (; blocked; blocked &= blocked - 1) {
      int i = std::countr_zero(blocked);
      vec3 tint = eval_blocked(transport, seen.rays, i);
      if (max_component(tint) > 0)
        add_lambert_lanes(source, pass, seen, radiance * tint, 1u << i, sum);
    }
  });
}

}  // namespace wellspring::light
