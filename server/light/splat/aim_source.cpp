// SPDX-License-Identifier: Apache-2.0
#include "light/splat/aim_source.h"

#include <algorithm>
#include <cmath>

#include "light/random/warp.h"
#include "light/sample/emission.h"
#include "light/sample/light_tables.h"

namespace wellspring::light {
namespace {

// Changes smoothly with the direction but near straight up and down, so that rays of a source that
// turns do not jump.
void make_steady_axes(vec3 axis, vec3& along, vec3& across) {
  vec3 side = cross(vec3(0, 1, 0), axis);
  float length2 = dot(side, side);
  if (length2 < 1e-6f) return make_frame_axes(axis, along, across);
  along = side / std::sqrt(length2);
  across = cross(axis, along);
}

bool is_parallel(const SplatSource& source) {
  return source.kind == SplatSourceKind::sun || (source.kind == SplatSourceKind::punctual &&
                                                 source.light.type == PunctualType::directional);
}

// As seen along the light: across it, and along.
Bounds see_from_light(const SourceAim& aim, Bounds bounds, const Bounds& moving) {
  bounds.low = min(bounds.low, moving.low), bounds.high = max(bounds.high, moving.high);
  Bounds seen;
  for (int i = 0; i < 8; i++) {
    vec3 p(i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
           i & 4 ? bounds.high.z : bounds.low.z);
    vec3 place(dot(p, aim.along), dot(p, aim.across), dot(p, aim.axis));
    seen.low = min(seen.low, place), seen.high = max(seen.high, place);
  }
  return seen;
}

// A rectangle before the scene, across the light, as large as what reflects light needs.
void fit_window(const Transport& transport, SourceAim& aim) {
  const Bounds moving = transport.world.moving_bounds();
  const Bounds lit = see_from_light(aim, transport.tables.lit_bounds, moving);
  const Bounds all = see_from_light(aim, transport.tables.bounds, moving);
  if (!is_finite(lit.low) || !is_finite(lit.high) || !is_finite(all.low) || !is_finite(all.high))
    return;
  const vec3 low = lit.low, size = lit.high - lit.low;
  const float back = all.low.z - 0.01f * (all.high.z - all.low.z) - 1e-3f;
  aim.corner = aim.along * low.x + aim.across * low.y + aim.axis * back;
  aim.width = aim.along * size.x;
  aim.height = aim.across * size.y;
}

// Shirley and Chiu 1997: square to disc, area kept, neighbours stay neighbours. u: -1 to 1.
vec2 to_disc(vec2 u) {
  if (u.x == 0 && u.y == 0) return vec2(0);
  bool wide = std::abs(u.x) > std::abs(u.y);
  float radius = wide ? u.x : u.y;
  float angle = wide ? pi / 4 * (u.y / u.x) : pi / 2 - pi / 4 * (u.x / u.y);
  return radius * vec2(std::cos(angle), std::sin(angle));
}

vec3 cube_direction(int face, vec2 u) {
  float side = face & 1 ? -1.0f : 1.0f;
  switch (face / 2) {
    case 0: return {side, u.y, -side * u.x};
    case 1: return {u.x, side, -side * u.y};
    default: return {side * u.x, u.y, side};
  }
}

void aim_punctual(const SourceAim& aim, const MapCell& cell, vec2 u, SourceRay& to) {
  const PunctualLight& light = aim.source.light;
  to.ray.origin = light.position;
  to.ray.t_min = aim.source.radius;
  to.range = light.range;
  to.flux = light.intensity;
  if (light.type == PunctualType::point) {
    if (cell.faces == 6) {
      vec2 place = 2.0f * u - 1.0f;
      vec3 way = cube_direction(cell.face, place);
      float length2 = dot(way, way);
      to.ray.direction = way / std::sqrt(length2);
      to.spread = 24 / (length2 * std::sqrt(length2));  // 4 of a face's square, 6 faces
    } else {
      to.ray.direction = sample_sphere(u);
      to.spread = 4 * pi;
    }
  } else {
    vec2 disc = to_disc(2.0f * u - 1.0f);
    float share = dot(disc, disc), z = 1 - share * (1 - aim.outer);
    float radius = std::sqrt(std::max(0.0f, 1 - z * z)), from = std::sqrt(share);
    vec2 rim = from > 0 ? disc * (radius / from) : vec2(0);
    to.ray.direction = aim.along * rim.x + aim.across * rim.y + aim.axis * z;
    to.spread = 2 * pi * (1 - aim.outer);
    float t = glm::clamp((z - aim.outer) * aim.scale, 0.0f, 1.0f);
    to.flux *= t * t;
  }
  to.flux *= to.spread;
}

void aim_emitters(const SourceAim& aim, const MapCell& cell, Sampler& sampler, SourceRay& to) {
  const LightTables& tables = aim.transport.tables;
  const uint32_t count = aim.source.count;
  if (!(aim.power > 0)) return;
  double wanted = aim.power * (double(cell.column) + double(sampler.next())) / cell.columns;
  auto power = [&](uint32_t i) {
    return std::max(0.0f, tables.emitter_power[aim.source.first + i]);
  };
  while (aim.next + 1 < count && aim.passed + double(power(aim.next)) <= wanted)
    aim.passed += double(power(aim.next++));
  const uint32_t triangle = aim.source.first + aim.next;
  float chance = float(double(power(aim.next)) / aim.power);
  const EmitterTriangle& e = tables.emitters[triangle];
  EmitterPlace place = sample_emitter_place(aim.transport, triangle, sampler.next2());
  vec2 way = sampler.next2();
  float sides = e.double_sided ? 2 : 1;
  vec3 normal = e.normal;
  if (e.double_sided) {
    if (way.x < 0.5f) normal = -normal;
    way.x = way.x < 0.5f ? 2 * way.x : 2 * way.x - 1;
  }
  vec3 local = sample_cosine_hemisphere(way), along, across;
  make_frame_axes(normal, along, across);
  to.ray.direction = along * local.x + across * local.y + normal * local.z;
  to.ray.origin = offset_origin(place.surface, to.ray.direction);
  if (!(chance > 0)) return;
  to.flux = place.radiance * (pi * e.area * sides / chance);
  to.spread = pi * sides / std::max(local.z, 0.1f);
}

}  // namespace

SourceAim aim_source(const Transport& transport, const SplatSource& source) {
  SourceAim aim{transport, source};
  const PunctualLight& light = source.light;
  const LightTables& tables = transport.tables;
  if (source.kind == SplatSourceKind::sun) aim.axis = -tables.environment.sun_direction;
  if (source.kind == SplatSourceKind::punctual && light.type != PunctualType::point)
    aim.axis = light.direction;
  make_steady_axes(aim.axis, aim.along, aim.across);
  if (is_parallel(source)) fit_window(transport, aim);
  if (source.kind == SplatSourceKind::punctual && light.type == PunctualType::spot) {
    aim.outer = std::cos(light.outer_cone);
    aim.scale = 1 / std::max(0.001f, std::cos(light.inner_cone) - aim.outer);
  }
  if (source.kind == SplatSourceKind::emitters)
    for (uint32_t i = 0; i < source.count; i++)
      aim.power += double(std::max(0.0f, tables.emitter_power[source.first + i]));
  return aim;
}

float window_aspect(const Transport& transport, const SplatSource& source) {
  if (!is_parallel(source)) return 1;
  SourceAim aim = aim_source(transport, source);
  float width = length(aim.width), height = length(aim.height);
  return width > 0 && height > 0 ? glm::clamp(width / height, 0.01f, 100.0f) : 1.0f;
}

void aim_at_cell(const SourceAim& aim, const MapCell& cell, Sampler& sampler, SourceRay& to) {
  to = {};
  to.range = std::numeric_limits<float>::infinity();
  const EnvironmentLight& sky = aim.transport.tables.environment;
  if (aim.source.kind == SplatSourceKind::emitters) return aim_emitters(aim, cell, sampler, to);
  if (aim.source.kind == SplatSourceKind::sky) {
    const EmissionChoice& scene = aim.transport.tables.emission;
    EnvironmentSample sample = sample_whole_sky(sky, sampler.next2());
    vec2 disc = scene.radius * to_disc(2.0f * sampler.next2() - 1.0f);
    if (!(sample.pdf > 0)) return;
    vec3 along, across;
    make_frame_axes(sample.direction, along, across);
    to.parallel = true;
    to.spread = pi * scene.radius * scene.radius;
    to.ray.direction = -sample.direction;
    to.ray.origin =
        scene.centre + sample.direction * (2 * scene.radius) + along * disc.x + across * disc.y;
    to.flux = eval_environment(sky, sample.direction) * (to.spread / sample.pdf);
    return;
  }
  vec2 u = sampler.next2();
  u = (vec2(cell.column, cell.row) + u) / vec2(cell.columns, cell.rows);
  if (!is_parallel(aim.source)) return aim_punctual(aim, cell, u, to);
  to.parallel = true;
  to.ray.origin = aim.corner + aim.width * u.x + aim.height * u.y;
  to.spread = length(aim.width) * length(aim.height);
  to.ray.direction = aim.axis;
  to.flux = aim.source.light.intensity * to.spread;
  if (aim.source.kind != SplatSourceKind::sun) return;
  float below = 0.5f * sky.sun_chord2 * sampler.next();  // 1 - cosine
  vec2 rim = std::sqrt(below * (2 - below)) * unit_circle(sampler.next());
  vec3 direction = aim.along * rim.x + aim.across * rim.y + aim.axis * (1 - below);
  to.ray.direction = direction;
  to.flux = sky.sun_radiance * (pi * sky.sun_chord2) * to.spread;
}

}  // namespace wellspring::light
