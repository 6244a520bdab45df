// SPDX-License-Identifier: Apache-2.0
#include "light/point_light_shading.h"

#include <algorithm>
#include <cmath>

#include "light/emission.h"
#include "light/walk.h"

namespace wellspring {
namespace {

constexpr int lanes = RayPacket::lanes;

// One number per place.
struct alignas(64) Lane {
  float v[lanes];
  float& operator[](int i) { return v[i]; }
  float operator[](int i) const { return v[i]; }
};
struct Lane3 {
  Lane x, y, z;
  void set(int i, vec3 p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
  vec3 at(int i) const { return {x[i], y[i], z[i]}; }
};

struct Group {
  const LitPlace* places;
  int count;
  uint32_t used = 0;     // lanes with a place
  uint32_t matt = 0;     // that are Lambert's, and nothing else
  uint32_t through = 0;  // that scatter light from behind, too
  Lane3 position, origin, normal, face;
  Lane3 sum;  // of matt lanes: irradiance
};

Group make_group(const LitPlace* places, int count) {
  Group group{};
  group.places = places;
  group.count = count;
  for (int i = 0; i < lanes; i++) {
    const LitPlace& place = places[i < count ? i : 0];
    const Bsdf& bsdf = *place.bsdf;
    group.position.set(i, place.surface->position);
    group.origin.set(i, offset_origin(*place.surface, place.surface->geometric_normal));
    group.normal.set(i, bsdf.normal);
    group.face.set(i, bsdf.geometric_normal);
    if (i >= count) continue;
    group.used |= 1u << i;
    bool plain = place.media->here.count == 0 && place.hue() < 0;
    if (!has_specular(bsdf) && plain) group.matt |= 1u << i;
    if (max_component(bsdf.transmit) > 0 && smoothest_alpha(bsdf) >= place.sharp)
      group.through |= 1u << i;
  }
  return group;
}

// Aims every lane's ray from `target` to where it would leave its surface; unit of t: the way there. Rays
// with one origin make a narrower packet than rays with one end.
void aim(const Group& group, vec3 target, RayPacket& rays) {
  for (int i = 0; i < lanes; i++) {
    rays.origin_x[i] = target.x;
    rays.origin_y[i] = target.y;
    rays.origin_z[i] = target.z;
    rays.direction_x[i] = group.origin.x[i] - target.x;
    rays.direction_y[i] = group.origin.y[i] - target.y;
    rays.direction_z[i] = group.origin.z[i] - target.z;
    rays.t_max[i] = 1;
  }
}

void aim_lane(RayPacket& rays, int i, vec3 origin, vec3 direction, float t_max) {
  rays.origin_x[i] = origin.x, rays.origin_y[i] = origin.y, rays.origin_z[i] = origin.z;
  rays.direction_x[i] = direction.x, rays.direction_y[i] = direction.y;
  rays.direction_z[i] = direction.z;
  rays.t_max[i] = t_max;
}

uint32_t bits_of(const bool* flags) {
  uint32_t bits = 0;
  for (int i = 0; i < lanes; i++) bits |= uint32_t(flags[i]) << i;
  return bits;
}

// A light as each lane sees it.
struct Seen {
  uint32_t active = 0;
  Lane3 direction;   // not unit where `distance2` says so
  Lane distance2;    // squared length of direction
  Lane cosine;       // matt lanes: at the surface, unit
  Lane strength;     // incident light at a facing surface is this times the light's radiance
  RayPacket rays;
};

void see_area(const Group& group, const PointLight& light, float clip2, Seen& seen) {
  bool lit[lanes], back[lanes];
  for (int i = 0; i < lanes; i++) {
    float dx = light.position.x - group.position.x[i], dy = light.position.y - group.position.y[i],
          dz = light.position.z - group.position.z[i];
    float d2 = dx * dx + dy * dy + dz * dz;
    float inverse = 1 / std::sqrt(std::max(d2, 1e-30f));
    float here = (group.normal.x[i] * dx + group.normal.y[i] * dy + group.normal.z[i] * dz) * inverse;
    float face = group.face.x[i] * dx + group.face.y[i] * dy + group.face.z[i] * dz;
    float there =
        -(light.normal.x * dx + light.normal.y * dy + light.normal.z * dz) * inverse;
    seen.direction.x[i] = dx, seen.direction.y[i] = dy, seen.direction.z[i] = dz;
    seen.distance2[i] = d2;
    seen.cosine[i] = here;
    back[i] = there < 0;
    seen.strength[i] = std::abs(there) / std::max(d2, clip2);
    lit[i] = d2 > 1e-20f && here > 0 && face > 0 && there != 0;
  }
  seen.active = bits_of(lit) | group.through;
  if (!light.double_sided) seen.active &= ~bits_of(back);
  seen.active &= group.used;
  if (seen.active == 0) return;
  aim(group, light.target, seen.rays);
  uint32_t odd = seen.active & (group.through | (light.double_sided ? bits_of(back) : 0));
  for (int i = 0; odd >> i != 0; i++) {  // sides other than the usual ones
    if (!(odd >> i & 1)) continue;
    vec3 origin = offset_origin(*group.places[i].surface, seen.direction.at(i));
    vec3 target = back[i] ? 2.0f * light.position - light.target : light.target;
    aim_lane(seen.rays, i, target, origin - target, 1);
  }
}

void see_distant(const Group& group, vec3 direction, Seen& seen) {
  bool lit[lanes];
  for (int i = 0; i < lanes; i++) {
    vec3 n = group.normal.at(i), g = group.face.at(i);
    seen.direction.set(i, direction);
    seen.distance2[i] = 1;
    seen.cosine[i] = dot(n, direction);
    seen.strength[i] = 1;
    lit[i] = seen.cosine[i] > 0 && dot(g, direction) > 0;
  }
  seen.active = (bits_of(lit) | group.through) & group.used;
  for (int i = 0; i < lanes; i++) {
    vec3 origin = group.through >> i & 1 ? offset_origin(*group.places[i].surface, direction)
                                         : group.origin.at(i);
    aim_lane(seen.rays, i, origin, direction, std::numeric_limits<float>::infinity());
  }
}

// `light.radiance` becomes intensity times that; colours differ by direction only in strength.
void see_punctual(const LightTables& tables, const Group& group, size_t index, Seen& seen) {
  const PunctualLight& punctual = tables.punctual[index];
  if (punctual.type == PunctualType::directional)
    return see_distant(group, -punctual.direction, seen);
  const SpotCone& cone = tables.cones[index];
  bool spot = punctual.type == PunctualType::spot, lit[lanes];
  for (int i = 0; i < lanes; i++) {
    vec3 line = punctual.position - group.position.at(i);
    float d2 = dot(line, line), inverse = 1 / std::sqrt(std::max(d2, 1e-30f));
    seen.direction.set(i, line);
    seen.distance2[i] = d2;
    seen.cosine[i] = dot(group.normal.at(i), line) * inverse;
    float t = glm::clamp((-dot(line, punctual.direction) * inverse - cone.outer) * cone.scale, 0.0f,
                         1.0f);
    float range = range_window(d2 * inverse, punctual.range);
    seen.strength[i] = (spot ? t * t : 1.0f) * range / std::max(d2, 1e-20f);
    lit[i] = d2 > 1e-20f && seen.strength[i] > 0 &&
             (group.through >> i & 1 ||
              (seen.cosine[i] > 0 && dot(group.face.at(i), line) > 0));
  }
  seen.active = bits_of(lit) & group.used;
  if (seen.active == 0) return;
  aim(group, punctual.position, seen.rays);
  uint32_t odd = seen.active & group.through;
  for (int i = 0; odd >> i != 0; i++) {
    if (!(odd >> i & 1)) continue;
    vec3 origin = offset_origin(*group.places[i].surface, seen.direction.at(i));
    aim_lane(seen.rays, i, punctual.position, origin - punctual.position, 1);
  }
}

// What of the light arrives through thin panes where something is in between.
vec3 through_panes(const Transport& transport, const Group& group, const PointLight& light,
                   const Seen& seen, int i) {
  vec3 origin{seen.rays.origin_x[i], seen.rays.origin_y[i], seen.rays.origin_z[i]};
  vec3 way{seen.rays.direction_x[i], seen.rays.direction_y[i], seen.rays.direction_z[i]};
  Ray ray;
  ray.origin = origin;
  ray.direction = way;
  ray.t_max = seen.rays.t_max[i];
  if (!may_cross_pane(transport.tables.pane_boxes, ray)) return vec3(0);
  LightSample sample;
  sample.direction = normalize(way);
  if (std::isfinite(seen.rays.t_max[i])) {
    sample.direction = -sample.direction;
    sample.distance = std::sqrt(seen.distance2[i]);
    sample.target = origin;
  }
  return eval_visibility(transport, *group.places[i].surface, sample);
}

void add_lane(const Transport& transport, const Group& group, const PointLight& light,
              const InstantPass& pass, const Seen& seen, vec3 radiance, int i, PlaceLight& sum) {
  const LitPlace& place = group.places[i];
  if (light.hue >= 0) radiance *= meet_hues(place.hue(), light.hue);
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
    radiance *= eval_absorption(transport, medium_towards(*place.media, *place.surface, direction),
                                std::isfinite(seen.rays.t_max[i])
                                    ? distance
                                    : std::numeric_limits<float>::infinity());
  (light.exact ? sum.exact_diffuse : sum.diffuse) += value.diffuse * radiance;
  (light.exact ? sum.exact_specular : sum.specular) += value.specular * radiance;
}

uint32_t occluded_each(const World& world, const RayPacket& rays, uint32_t active) {
  uint32_t blocked = 0;
  for (int i = 0; active >> i != 0; i++) {
    if (!(active >> i & 1)) continue;
    Ray ray;
    ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
    ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    ray.t_min = 0;
    ray.t_max = rays.t_max[i];
    blocked |= uint32_t(world.occluded(ray)) << i;
  }
  return blocked;
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
  size_t cell = size_t(choice.region) * size_t(pass.sets()) + size_t(choice.set);
  const RegionLights& regions = pass.regions;
  for (uint32_t k = regions.first[cell]; k < regions.first[cell + 1]; k++)
    visit(pass.lights[regions.lights[k].light], regions.lights[k].factor);
}

}  // namespace

void shade_by_point_lights(const Transport& transport, const InstantPass& pass,
                           const SetShare& choice, int max_depth, const LitPlace* places,
                           int count, PlaceLight* light) {
  Group group = make_group(places, count);
  int deepest = 0;
  for (int i = 0; i < count; i++) deepest = std::max(deepest, max_depth - 1 - places[i].depth);
  float clip2 = pass.clip * pass.clip;
  Seen seen;
  for_each_asked(pass, choice, [&](const PointLight& source, float factor) {
    if (source.depth > deepest) return;
    vec3 radiance = source.radiance * factor;
    switch (source.kind) {
      case PointLightKind::punctual:
        see_punctual(transport.tables, group, source.index, seen);
        radiance *= transport.tables.punctual[source.index].intensity;
        break;
      case PointLightKind::distant: see_distant(group, source.position, seen); break;
      default: see_area(group, source, clip2, seen);
    }
    for (int i = 0; i < count; i++)
      if (places[i].depth + 1 + int(source.depth) > max_depth) seen.active &= ~(1u << i);
    if (seen.active == 0) return;
    uint32_t blocked = choice.few.empty()
                           ? transport.world.occluded_packet(seen.rays, seen.active)
                           : occluded_each(transport.world, seen.rays, seen.active);
    uint32_t clear = seen.active & ~blocked;
    bool quick = source.kind != PointLightKind::scattering && !source.exact;
    for (int i = 0; i < lanes; i++) {
      bool taken = quick && (clear & group.matt) >> i & 1;
      float arrives = taken ? seen.strength[i] * seen.cosine[i] : 0.0f;
      group.sum.x[i] += arrives * radiance.x;
      group.sum.y[i] += arrives * radiance.y;
      group.sum.z[i] += arrives * radiance.z;
    }
    uint32_t slow = quick ? clear & ~group.matt : clear;
    for (int i = 0; slow >> i != 0; i++)
      if (slow >> i & 1)
        add_lane(transport, group, source, pass, seen, radiance, i, light[i]);
    if (!transport.tables.any_pane) return;
    for (int i = 0; blocked >> i != 0; i++) {
      if (!(blocked >> i & 1)) continue;
      vec3 tint = through_panes(transport, group, source, seen, i);
      if (max_component(tint) > 0)
        add_lane(transport, group, source, pass, seen, radiance * tint, i, light[i]);
    }
  });
  for (int i = 0; i < count; i++)
    if (group.matt >> i & 1) light[i].diffuse += group.sum.at(i) * places[i].bsdf->diffuse / pi;
}

}  // namespace wellspring
