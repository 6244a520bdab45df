// SPDX-License-Identifier: Apache-2.0
#include "light/sample/sample_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/simd.h"
#include "light/random/warp.h"

namespace wellspring::light {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

constexpr float below_one = 0x1.fffffep-1f;

// Returns the radiance of an emitter that is not the same all over, at one place of it.
vec3 emission_at(const World& world, const EmitterTriangle& e, const Ray& ray, float distance,
                 vec2 barycentric) {
  Hit hit;
  hit.t = distance;
  hit.instance = e.instance;
  hit.triangle = e.triangle;
  hit.barycentric = barycentric;
  Surface shown = eval_surface(world, ray, hit);
  const Material& material = world.material_of(e.instance);
  float cover = 1;
  if (material.alpha_mode == AlphaMode::mask) cover = shown.alpha < material.alpha_cutoff ? 0 : 1;
  if (material.alpha_mode == AlphaMode::blend) cover = shown.alpha;
  return surface_emission(shown, material) * cover;
}

LightSample sample_emitter(const Transport& transport, const SurfacePlace& from, vec3 normal,
                           vec2 u, Sampler& sampler) {
  const LightTables& tables = transport.tables;
  LightPick pick = pick_light(tables.emitter_choice, from.position, normal, u.x);
  if (!(pick.probability > 0)) return {};
  // A choice among many leaves too few digits of the number.
  if (pick.probability < 0x1p-10f) pick.u = sampler.next();
  const EmitterTriangle& e = tables.emitters[pick.index];
  PicturePlace at{sample_triangle({pick.u, u.y}), 1};
  if (e.picture >= 0)
    at = sample_emission_picture(tables.pictures[size_t(e.picture)], {pick.u, u.y});
  SurfacePlace place;
  place.position = e.corner + at.barycentric.x * e.edge1 + at.barycentric.y * e.edge2;
  place.geometric_normal = e.normal;
  place.extent = e.extent;
  vec3 line = place.position - from.position;
  float distance2 = dot(line, line);
  LightSample light;
  if (!(distance2 > 0) || !(e.area > 0)) return light;
  light.distance = std::sqrt(distance2);
  light.direction = line / light.distance;
  float cosine = -dot(light.direction, e.normal);
  if (cosine <= 0) {
    if (!e.double_sided) return light;
    cosine = -cosine;
  }
  if (cosine < 1e-7f) return light;
  light.radiance = e.emission;
  if (!e.uniform) {
    Ray ray;
    ray.origin = from.position;
    ray.direction = light.direction;
    light.radiance = emission_at(transport.world, e, ray, light.distance, at.barycentric);
  }
  if (tables.spectral) light.spectrum = transport.world.material_of(e.instance).spectra.emission;
  light.target = offset_origin(place, -light.direction);
  light.pdf = tables.emitter_share * pick.probability * at.density * distance2 / (cosine * e.area);
  return light;
}

}  // namespace

vec3 lit_side(const Surface& surface, const Bsdf& bsdf) {
  return max_component(bsdf.transmit) > 0 ? vec3(0) : surface.geometric_normal;
}

LightSample sample_area_light(const Transport& transport, const SurfacePlace& from, vec3 normal,
                              Sampler& sampler) {
  const LightTables& tables = transport.tables;
  bool emitters = !tables.emitter_choice.empty(), sky = tables.environment.is_sampled();
  if (!emitters && !sky) return {};
  vec2 u = sampler.next2();
  if (emitters) {
    if (!sky) return sample_emitter(transport, from, normal, u, sampler);
    if (u.x < tables.emitter_share) {
      u.x = std::min(u.x / tables.emitter_share, below_one);
      return sample_emitter(transport, from, normal, u, sampler);
    }
    u.x = std::min((u.x - tables.emitter_share) / (1 - tables.emitter_share), below_one);
  }
  EnvironmentSample s = sample_environment(tables.environment, u);
  LightSample light;
  light.direction = s.direction;
  light.radiance = eval_environment(tables.environment, s.direction);
  light.pdf = (1 - tables.emitter_share) * s.pdf;
  return light;
}

float sample_emitter_pdf(const LightTables& tables, vec3 from, vec3 normal, vec3 direction,
                         const Surface& met) {
  uint32_t first = tables.first_emitter[met.instance];
  if (first == no_emitter || tables.emitter_choice.empty()) return 0;
  const EmitterTriangle& e = tables.emitters[first + met.triangle];
  float cosine = std::abs(dot(direction, e.normal));
  if (!(e.area > 0) || cosine < 1e-7f) return 0;
  vec3 line = met.position - from;
  float density = 1;
  if (e.picture >= 0)
    density = sample_emission_picture_pdf(tables.pictures[size_t(e.picture)], met.barycentric);
  return tables.emitter_share * density *
         pick_light_probability(tables.emitter_choice, from, normal, first + met.triangle) *
         dot(line, line) / (cosine * e.area);
}

float sample_sky_pdf(const LightTables& tables, vec3 direction) {
  return (1 - tables.emitter_share) * sample_environment_pdf(tables.environment, direction);
}

namespace {

// Returns what the panes that a ray passed let through together.
vec3 pass_panes(const Transport& transport, const Ray& ray, PanesPassed& panes) {
  const World& world = transport.world;
  // They come in the order of the tree, on which results may not depend.
  std::sort(panes.hits, panes.hits + panes.count, [](const Hit& a, const Hit& b) {
    return a.instance != b.instance ? a.instance < b.instance : a.triangle < b.triangle;
  });
  vec3 arrives(1);
  for (int i = 0; i < panes.count; i++) {
    int index = world.mesh_of(panes.hits[i].instance).material;
    if (!transport.tables.materials[size_t(index)].maybe_pane) return vec3(0);
    Surface surface = eval_surface(world, ray, panes.hits[i]);
    const Material& material = world.material_of(panes.hits[i].instance);
    if (!is_pane(surface, material)) return vec3(0);
    arrives *= pane_transmittance(surface, material, ray.direction);
  }
  return arrives;
}

// Returns the same for any number of panes, one after the other.
vec3 step_through_panes(const World& world, Ray ray) {
  const bool ends = std::isfinite(ray.t_max);
  const vec3 way = ray.direction, end = ray.origin + way * (ends ? ray.t_max : 0.0f);
  vec3 arrives(1);
  for (int pane = 0; pane < most_panes; pane++) {
    Hit hit = world.intersect(ray);
    if (!hit.valid()) return arrives;
    Surface surface = eval_surface(world, ray, hit);
    const Material& material = world.material_of(hit.instance);
    if (!is_pane(surface, material)) return vec3(0);
    arrives *= pane_transmittance(surface, material, ray.direction);
    if (!(max_component(arrives) > 0)) return vec3(0);
    ray.origin = offset_origin(surface, ray.direction);
    if (!ends) continue;
    vec3 line = end - ray.origin;
    ray.t_max = length(line);
    if (!(ray.t_max > 0) || dot(line, way) <= 0) return arrives;
    ray.direction = line / ray.t_max;
  }
  return vec3(0);
}

}  // namespace

vec3 eval_visibility(const Transport& transport, const SurfacePlace& from,
                     const LightSample& light) {
  Ray ray;
  ray.origin = offset_origin(from, light.direction);
  ray.direction = light.direction;
  if (std::isfinite(light.distance)) {
    // The direction is as long as the way: no ray needs a unit direction to ask what is in between.
    ray.direction = light.target - ray.origin;
    ray.t_max = 1;
    if (!(dot(ray.direction, light.direction) > 0)) return vec3(1);
  }
  return eval_visibility(transport, ray);
}

vec3 eval_visibility(const Transport& transport, Ray ray) {
  const World& world = transport.world;
  if (!transport.tables.any_pane) return world.occluded(ray) ? vec3(0) : vec3(1);
  PanesPassed panes;
  bool blocked = world.occluded(ray, panes);
  if (blocked && !panes.more) return vec3(0);
  if (panes.count == 0) return vec3(1);
  float length = std::sqrt(dot(ray.direction, ray.direction));
  ray.direction /= length;
  ray.t_max *= length;
  return panes.more ? step_through_panes(world, ray) : pass_panes(transport, ray, panes);
}

vec3 eval_blocked(const Transport& transport, const RayPacket& rays, int i) {
  if (!transport.tables.any_pane) return vec3(0);
  Ray ray;
  ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
  ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
  ray.t_max = rays.t_max[i];
  return may_cross_pane(transport.tables.pane_boxes, ray) ? eval_visibility(transport, ray)
                                                          : vec3(0);
}

namespace {

// Returns whether light of a sample is finite and not below `least`. Works bit by bit: one branch
// for all.
bool is_light(const Sample& sample, float least) {
  constexpr float most = std::numeric_limits<float>::max();
  static_assert(offsetof(Sample, rest) == offsetof(Sample, albedo) + 6 * sizeof(float));
  const vec3 sum = sample.radiance();
  const Lanes first = load_lanes(&sample.albedo.x);  // all but the last number of `rest`
  const Lanes others = {sample.rest.z, sum.x, sum.y, sum.z, 0, 0, 0, 0};
  const Lanes low = all_lanes(least);
  // NaN is neither above nor below.
  LaneMask fine = (first >= low) & (first <= most) & (others >= low) & (others <= most);
  return negative_lanes(fine) == 0xff;
}

}  // namespace

void finish_samples(const Lights& lights, const TransportSettings& settings,
                    std::span<Sample> samples) {
  // Hues beyond the colours of a display are below zero in a channel; in the mean they mix.
  const SpectralTables* spectral = lights.tables->spectral.get();
  const float least =
      spectral && !spectral->rows.empty() ? -std::numeric_limits<float>::max() : 0.0f;
  for (Sample& sample : samples) {
    if (!is_light(sample, least)) {
      lights.bad_samples->fetch_add(1, std::memory_order_relaxed);
      sample.albedo = sample.smooth = sample.rest = sample.glow = vec3(0);
      sample.flags &= uint8_t(~sample_sure);
    }
    if (!(settings.clamp > 0)) continue;
    // Light that owes nothing to chance, such as a lamp that is looked at, keeps its brightness.
    vec3 sure = sample.flags & sample_sure ? sample.rest : sample.glow;
    // Nor is a map's light clamped.
    vec3 mapped = sample.flags & sample_mapped ? min(sample.smooth, vec3(1)) : vec3(0);
    vec3 chance = sample.radiance() - sure - sample.albedo * sample.known * mapped;
    float largest = max_component(chance), share = settings.clamp / largest;
    if (!(largest > settings.clamp)) continue;
    sample.smooth = mapped + (sample.smooth - mapped) * share;
    sample.rest = sure + (sample.rest - sure) * share;
  }
}

}  // namespace wellspring::light
