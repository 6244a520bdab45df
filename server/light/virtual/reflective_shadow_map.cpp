// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/reflective_shadow_map.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "light/material/bsdf.h"
#include "light/random/warp.h"
#include "light/sample/emission.h"
#include "light/sample/light_tables.h"
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {
namespace {

float power_or_none(float power) { return std::isfinite(power) && power > 0 ? power : 0; }

float punctual_power(const PunctualLight& light, float radius) {
  float strength = luminance(light.intensity);
  switch (light.type) {
    case PunctualType::point: return 4 * pi * strength;
    // This is about the mean of the fall-off between both cones.
    case PunctualType::spot:
      return 2 * pi * strength *
             (1 - 0.5f * (std::cos(light.inner_cone) + std::cos(light.outer_cone)));
    case PunctualType::directional: return pi * radius * radius * strength;
  }
  return 0;
}

}  // namespace

SplatSource make_splat_source(const PunctualLight& light, uint64_t id) {
  SplatSource source;
  source.light = light;
  source.id = id;
  return source;
}

std::vector<SplatSource> make_all_splat_sources(const Transport& transport) {
  const LightTables& tables = transport.tables;
  constexpr uint64_t punctual_ids = 1ull << 40, sky_id = 1ull << 41;
  std::vector<SplatSource> sources;
  auto add = [&](const SplatSource& source) {
    if (eval_source_power(transport, source) > 0) sources.push_back(source);
  };
  for (size_t i = 0; i < tables.punctual.size(); i++) {
    // The number is the light's in the scene's list, whichever lamps are on.
    uint64_t number = i < tables.punctual_index.size() ? tables.punctual_index[i] : i;
    add(make_splat_source(tables.punctual[i], punctual_ids + number));
  }
  for (size_t begin = 0; begin < tables.emitters.size();) {
    size_t end = begin;
    while (end < tables.emitters.size() &&
           tables.emitters[end].instance == tables.emitters[begin].instance)
      end++;
    SplatSource source;
    source.kind = SplatSourceKind::emitters;
    source.first = uint32_t(begin);
    source.count = uint32_t(end - begin);
    source.id = tables.emitters[begin].instance;
    add(source);
    begin = end;
  }
  SplatSource sky;
  sky.kind = SplatSourceKind::sky;
  sky.id = sky_id;
  add(sky);
  return sources;
}

float eval_source_power(const Transport& transport, const SplatSource& source) {
  const LightTables& tables = transport.tables;
  const float radius = tables.emission.radius, disc = pi * radius * radius;
  const EnvironmentLight& sky = tables.environment;
  const float sun = luminance(sky.sun_radiance) * sky.sun_chord2 * pi * disc;
  switch (source.kind) {
    case SplatSourceKind::punctual: return power_or_none(punctual_power(source.light, radius));
    case SplatSourceKind::emitters: {
      float sum = 0;
      size_t end = std::min(size_t(source.first) + source.count, tables.emitter_power.size());
      for (size_t i = source.first; i < end; i++) sum += power_or_none(tables.emitter_power[i]);
      return power_or_none(sum);
    }
    case SplatSourceKind::sky: return power_or_none(4 * pi * sky.mean_luminance * disc + sun);
    case SplatSourceKind::sun: return power_or_none(sun);
  }
  return 0;
}

namespace {

// Makes axes that change smoothly with the direction but near straight up and down, so that rays of
// a source that turns do not jump.
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

// Returns the bounds as seen along the light: x and y across it, z along.
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

// Fits a rectangle before the scene, across the light, as large as the surfaces that reflect light
// need.
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

// Maps a square to a disc (Shirley and Chiu 1997): area is kept, neighbours stay neighbours. u: -1
// to 1.
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

namespace {

constexpr int most_texels = 1 << 20;
constexpr float least_cosine = 0.1f;  // limit for a texel's area
// Metal rougher than that reflects about as a matte surface does.
constexpr float matte_alpha = 0.09f;

// Computes the sources' shares of all texels; the sum is 1, or 0 if nothing emits light.
void share_texels(const Transport& transport, std::span<const SplatSource> sources,
                  std::vector<double>& shares) {
  shares.clear();
  double sum = 0, roots = 0;
  for (const SplatSource& source : sources) {
    shares.push_back(double(eval_source_power(transport, source)));
    sum += shares.back();
    roots += std::sqrt(shares.back());
  }
  // Half is shared by power. A sun outshines every lamp, but not where its light does not reach.
  for (double& share : shares)
    share = sum > 0 ? 0.5 * share / sum + 0.5 * std::sqrt(share) / roots : 0;
}

struct MapShape {
  int faces, rows, columns;
};
MapShape shape_map(const Transport& transport, const SplatSource& source, int texels) {
  if (source.kind == SplatSourceKind::emitters || source.kind == SplatSourceKind::sky)
    return {1, 1, texels};
  bool point = source.kind == SplatSourceKind::punctual && source.light.type == PunctualType::point;
  if (point && texels < 6) return {1, 1, texels};
  int faces = point ? 6 : 1;
  float aspect = point ? 1 : window_aspect(transport, source);
  float side = std::sqrt(float(texels / faces) * aspect);
  int columns = std::clamp(int(side), 1, texels), rows = std::max(1, texels / faces / columns);
  return {faces, rows, columns};
}

// Calls visit(x, y) along Morton's curve.
template <class Visit>
void for_each_cell(int columns, int rows, const Visit& visit) {
  if (rows == 1) {
    for (int x = 0; x < columns; x++) visit(x, 0);
    return;
  }
  uint32_t side = std::bit_ceil(uint32_t(std::max(columns, rows)));
  auto every_second = [](uint32_t code) {
    code &= 0x55555555u;
    code = (code | code >> 1) & 0x33333333u;
    code = (code | code >> 2) & 0x0f0f0f0fu;
    code = (code | code >> 4) & 0x00ff00ffu;
    return int((code | code >> 8) & 0xffffu);
  };
  for (uint64_t code = 0; code < uint64_t(side) * side; code++) {
    int x = every_second(uint32_t(code)), y = every_second(uint32_t(code) >> 1);
    if (x < columns && y < rows) visit(x, y);
  }
}

void add_map(const Transport& transport, const SplatSource& source, double wanted, int texels,
             SplatSeed seed, ReflectiveShadowMap& map) {
  const MapShape shape = shape_map(transport, source, texels);
  const uint32_t count = uint32_t(shape.faces * shape.rows * shape.columns);
  const size_t first = map.aims.size();
  // A texel that was chosen by chance stands for those that were not.
  float worth = wanted < 1 ? float(1 / wanted) : 1 / float(count);
  SourceAim aim = aim_source(transport, source);
  uint64_t stream = mix64(seed.seed ^ mix64(source.id ^ 0x72736dull));
  for (int face = 0; face < shape.faces; face++)
    for_each_cell(shape.columns, shape.rows, [&](int x, int y) {
      Sampler sampler(stream, seed.pass * count + uint32_t(map.aims.size() - first));
      SourceRay& to = map.aims.emplace_back();
      aim_at_cell(aim, {face, y, x, shape.rows, shape.columns, shape.faces}, sampler, to);
      to.flux *= worth;
      to.spread *= worth;
      if (!is_finite(to.flux) || !(max_component(to.flux) > 0)) to.flux = vec3(0);
    });
}

vec3 matte_reflectance(const Bsdf& bsdf) {
  vec3 diffuse = bsdf.diffuse * (bsdf.has_coat ? bsdf.coat_passes : 1.0f);
  if (bsdf.metallic > 0 && bsdf.alpha >= matte_alpha) diffuse += bsdf.metal * bsdf.metallic;
  return min(diffuse * bsdf.beneath, vec3(1));
}

// Fills a texel with the surface there, behind panes that are looked through.
void light_texel(const Transport& transport, const SourceRay& aim, Hit hit,
                 ReflectiveTexel& texel) {
  texel = {};
  Ray ray = aim.ray;
  vec3 flux = aim.flux;
  float distance = 0;
  for (int panes = 0; hit.valid() && panes <= most_panes; panes++) {
    Surface surface = eval_surface(transport.world, ray, hit);
    const Material& material = transport.world.material_of(hit.instance);
    distance += hit.t;
    if (!is_pane(surface, material)) {
      if (material.unlit) return;
      Bsdf bsdf = make_bsdf_in(transport, {}, surface, material, ray.direction);
      texel.position = surface.position;
      texel.normal = surface.geometric_normal;
      texel.extent = surface.extent;
      texel.distance = distance;
      texel.flux = flux * matte_reflectance(bsdf) * range_window(distance, aim.range);
      float cosine = std::max(-dot(surface.geometric_normal, ray.direction), least_cosine);
      texel.area = aim.spread * (aim.parallel ? 1 : distance * distance) / cosine;
      bool fine = is_finite(texel.flux) && is_finite(texel.position) && is_finite(texel.normal) &&
                  std::isfinite(texel.area);
      if (!fine) texel = {};
      return;
    }
    flux *= pane_transmittance(surface, material, ray.direction);
    if (!(max_component(flux) > 0)) return;
    ray.origin = offset_origin(surface, ray.direction);
    hit = transport.world.intersect(ray);
  }
}

}  // namespace

void make_reflective_shadow_map(const Transport& transport, std::span<const SplatSource> sources,
                                const SplatSettings& settings, SplatSeed seed,
                                ReflectiveShadowMap& map) {
  map.aims.clear();
  share_texels(transport, sources, map.shares);
  const double texels = std::clamp(settings.texels, 1, most_texels);
  Sampler sampler(mix64(seed.seed ^ 0x736861726564ull), seed.pass);
  double passed = double(sampler.next());  // systematic sampling of the fractions
  for (size_t i = 0; i < sources.size(); i++) {
    double wanted = texels * map.shares[i];
    if (!(wanted > 0)) continue;
    int whole = int(wanted);
    if (wanted < 1) {
      passed += wanted;
      if (passed < 1) continue;
      passed -= 1;
      whole = 1;
    }
    add_map(transport, sources[i], wanted, whole, seed, map);
  }
  const int count = int(map.aims.size());
  map.texels.resize(size_t(count));
  map.rays = uint64_t(count);
  parallel_ranges(count, 64, [&](int begin, int end) {
    constexpr int together = 64;
    Ray rays[together];
    Hit hits[together];
    for (int first = begin; first < end; first += together) {
      int number = std::min(together, end - first);
      for (int i = 0; i < number; i++) rays[i] = map.aims[size_t(first + i)].ray;
      transport.world.intersect_many(rays, hits, number);
      for (int i = 0; i < number; i++)
        light_texel(transport, map.aims[size_t(first + i)], hits[i], map.texels[size_t(first + i)]);
    }
  });
  double sum = 0, number = 0;
  for (int i = 0; i < count; i++)
    if (!map.aims[size_t(i)].parallel && max_component(map.texels[size_t(i)].flux) > 0)
      sum += double(map.texels[size_t(i)].distance), number++;
  map.mean_distance = number > 0 ? float(sum / number) : 0;
}

}  // namespace wellspring::light
