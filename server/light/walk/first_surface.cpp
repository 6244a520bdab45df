// SPDX-License-Identifier: Apache-2.0
#include "light/walk/first_surface.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_types.h"
#include "light/walk/known_light.h"

namespace wellspring::light {
namespace {

constexpr float soft_alpha = least_soft_roughness * least_soft_roughness;

// Keeps one mirror image of those of all panes: `reflections` is the sum of what they reflect.
void add_reflection(FirstSurface& first, float& reflections, const Surface& surface,
                    const BsdfSample& mirrored, Sampler& sampler) {
  vec3 weight = first.tint * mirrored.weight;
  float strength = max_component(weight);
  if (!(strength > 0)) return;
  reflections += strength;
  if (sampler.next() * reflections >= strength) return;
  first.reflection = first.walk;
  first.reflection.throughput = vec3(1);
  BsdfSample unit = mirrored;
  unit.weight = weight / strength;
  advance(first.reflection, surface, unit);
}

// Adds what a surface emits to the sample's light, and to its glow.
void add_emission(vec3 tint, vec3 emission, Sample& sample) {
  vec3 light = tint * emission;
  sample.rest += light;
  sample.glow += light;
}

vec3 keep(vec3 diffuse, vec3 metal, float metallic, MetalDemodulation kept) {
  vec3 albedo = max_component(diffuse) > least_albedo ? diffuse : vec3(0);
  return kept == MetalDemodulation::none
             ? albedo
             : max(albedo + metal, vec3(least_demodulated_metal * metallic));
}

}  // namespace

DemodulatedReflectance demodulated_reflectance(const FirstSurface& first) {
  const Bsdf& b = first.bsdf;
  DemodulatedReflectance kept;
  kept.diffuse = max_component(b.diffuse) > least_albedo;
  kept.albedo = keep(b.diffuse, b.metallic * b.metal, b.metallic, first.metal);
  vec3 a = kept.albedo;
  if (first.metal != MetalDemodulation::none)
    kept.diffuse_share = kept.diffuse ? b.diffuse / a : vec3(0);
  if (first.metal == MetalDemodulation::light) {
    kept.lit_gloss = 1, kept.other_gloss = 1 - b.dielectric_share;
  } else if (b.alpha >= soft_alpha && !(max_component(b.transmit) > 0) &&
             std::min({a.x, a.y, a.z}) > least_demodulated_metal) {
    kept.lit_gloss = b.dielectric_share;
  }
  return kept;
}

vec3 demodulated_albedo(vec3 base_color, float metallic, MetalDemodulation metal) {
  metallic = clean(metallic);
  vec3 base = clean(base_color);
  return keep(base * (1 - metallic), base * metallic, metallic, metal);
}

void describe_place(const World& world, const Hit& hit, const SurfacePlace& place, vec3 normal,
                    float distance, Sample& sample) {
  sample.position = place.position;
  sample.normal = normal;
  sample.distance = distance;
  sample.object = world.object_of(hit.instance);
  sample.instance = hit.instance;
  sample.triangle = hit.triangle;
  sample.barycentric = hit.barycentric;
  sample.flags = uint8_t(sample_hit | (world.is_moving(hit.instance) ? sample_moving : 0));
}

bool see_volume(const Transport& transport, const Walk& walk, float t_end, vec3 tint,
                float distance, Sample& sample) {
  if (!transport.sees_volumes) return false;
  const std::optional<VolumeHit> met = transport.world.meet_volume(walk.ray, t_end, true);
  sample.rest += tint * transport.world.volume_glow(walk.ray, met ? met->t : t_end);
  if (!met) return false;
  sample.position = walk.ray.origin + met->t * walk.ray.direction;
  sample.normal = -walk.ray.direction;
  sample.distance = distance + met->t;
  sample.object = met->object;
  sample.rest +=
      tint * eval_absorption(transport, walk.media.here.innermost(), met->t) * met->color;
  sample.flags = sample_hit;
  return true;
}

void describe_sky(const Transport& transport, vec3 direction, vec3 tint, Sample& sample) {
  sample.position = direction;
  sample.distance = std::numeric_limits<float>::infinity();
  sample.rest += tint * eval_environment(transport.tables.environment, direction);
}

Walk begin_walk(const Transport& transport, const Request& request) {
  Walk walk;
  walk.ray = request.ray;
  if (transport.tables.any_solid) walk.media.here = find_media(transport, walk.ray.origin);
  return walk;
}

FirstSurface find_first_surface(const Transport& transport, int max_depth, const Request& request,
                                Sampler& sampler, Sample& sample) {
  Walk walk = begin_walk(transport, request);
  return find_first_surface(transport, max_depth, walk, transport.world.intersect(walk.ray),
                            sampler, sample);
}

FirstSurface find_first_surface(const Transport& transport, int max_depth, const Walk& begun,
                                Hit hit, Sampler& sampler, Sample& sample) {
  const World& world = transport.world;
  FirstSurface first;
  first.walk = begun;
  Walk& walk = first.walk;
  float distance = 0, reflections = 0;
  for (;; hit = world.intersect(walk.ray)) {
    first.by_chance = see_volume(transport, walk, hit.t, first.tint, distance, sample);
    if (first.by_chance) break;
    if (!hit.valid()) {
      describe_sky(transport, walk.ray.direction, first.tint, sample);
      break;
    }
    first.surface = meet_surface(transport, walk.ray, hit, walk.media);
    const Surface& surface = first.surface;
    const Material& material = world.material_of(hit.instance);
    distance += hit.t;
    first.tint *= eval_absorption(transport, walk.media.here.innermost(), hit.t);
    first.bsdf = make_bsdf_in(transport, walk.media, surface, material, walk.ray.direction);
    const Bsdf& bsdf = first.bsdf;
    bool clear =
        is_pane(surface, material) && !has_diffuse(bsdf) && bsdf.metallic == 0 && !material.unlit;
    if (clear && walk.panes < most_panes) {
      add_emission(first.tint, surface.emission, sample);
      if (max_depth > 1) add_reflection(first, reflections, surface, eval_mirror(bsdf), sampler);
      BsdfSample straight;
      straight.direction = walk.ray.direction;
      straight.weight = vec3(1);
      straight.bounce = Bounce::pass;
      first.tint *= pane_transmittance(surface, material, walk.ray.direction);
      advance(walk, surface, straight);
      continue;
    }
    describe_place(world, hit, surface, surface.normal, distance, sample);
    add_emission(first.tint, surface_emission(surface, material), sample);
    first.hit = hit;
    first.scatters = !material.unlit && (max_depth > 1 || is_clear_solid(bsdf));
    first.metal = traits_of(transport, hit).metal;
    break;
  }
  if (!first.scatters) sample.glow = vec3(0);
  first.mirrored = reflections > 0;
  first.reflection.throughput *= reflections;
  return first;
}

namespace {

// Returns whether a surface is a mirror, glass or polished metal: what is seen there moves with the
// view.
bool looks_specular(const Bsdf& bsdf) { return bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f; }

// Shades the first surface, its diffuse lobe (of reflectance 1) and its specular lobes sampled
// apart.
void shade_first(const Transport& transport, const WalkRules& rules, FirstSurface& first,
                 Sampler& sampler, Sample& sample) {
  const Walk& walk = first.walk;
  const Surface& surface = first.surface;
  const Material& material = transport.world.scene().materials[size_t(surface.material)];
  const vec3 tint = first.tint;
  Bsdf& bsdf = first.bsdf;
  const uint32_t base = Dimensions::first_surface;
  std::optional<WavelengthSpread> spread;
  part_colors(transport, walk, surface, base, sampler, bsdf, spread);
  DemodulatedReflectance kept = demodulated_reflectance(first);
  bool diffuse = kept.diffuse;
  KnownLight known;
  if (diffuse && first.metal == MetalDemodulation::none && walk.media.here.count == 0)
    known = find_known_light(transport, walk.ray, first.hit, surface);
  const bool read = known.known && rules.reads_maps && !may_be_shaded(transport, surface.position);
  vec3 albedo = kept.albedo, diffuse_albedo = kept.diffuse ? bsdf.diffuse : vec3(0);
  auto add_gloss = [&](vec3 light, float filtered) {
    if (filtered > 0) sample.smooth += filtered * light / albedo;
    if (filtered < 1) sample.rest += (1 - filtered) * tint * light;
  };
  bsdf.diffuse = diffuse ? vec3(1) : vec3(0);
  sample.albedo = albedo * tint;
  if (looks_specular(bsdf)) sample.flags |= sample_specular;
  if (has_specular(bsdf)) sample.flags &= uint8_t(~sample_sure);
  sampler.seek(base);
  if (!is_smooth(bsdf)) {
    DirectLight direct = sample_direct_light(transport, walk, surface, bsdf, true, sampler);
    if (known.known) direct.area_diffuse += direct.punctual_diffuse;
    if (!read) sample.smooth += walk.throughput * kept.diffuse_share * direct.area_diffuse;
    if (!known.known)
      sample.rest += tint * walk.throughput * diffuse_albedo * direct.punctual_diffuse;
    add_gloss(walk.throughput * direct.specular, kept.lit_gloss);
    if (!direct.sure_of_punctual()) sample.flags &= uint8_t(~sample_sure);
  }
  if (read) {
    sample.smooth += known.light * (bsdf.coat_passes * bsdf.beneath);
  } else if (diffuse) {
    Walk next = walk;
    next.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::diffuse, sampler);
    reflect(transport, material, bsdf, Lobes::diffuse, base, sampler, scattered, next.wavelengths);
    if (advance(next, surface, scattered)) {
      next.from_normal = lit_side(surface, bsdf);
      sampler.seek(Dimensions::walk);
      sample.smooth += kept.diffuse_share * follow(transport, rules, next, sampler);
    }
  }
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance = diffuse ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  sampler.seek(base + Dimensions::survival);
  if (has_specular(bsdf) && (chance == 1 || sampler.next() < chance)) {
    Walk next = walk;
    sampler.seek(base + Dimensions::specular);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, sampler);
    if (spread) carry_wavelengths(*spread, bsdf, Lobes::specular, scattered, next.wavelengths);
    reflect(transport, material, bsdf, Lobes::specular, base, sampler, scattered, next.wavelengths);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (scattered.bounce == Bounce::refract) next.density *= bsdf.eta * bsdf.eta;
    if (advance(next, surface, scattered)) {
      if (scattered.bounce != Bounce::pass) next.from_normal = lit_side(surface, bsdf);
      sampler.seek(2 * Dimensions::walk);
      add_gloss(follow(transport, rules, next, sampler), kept.other_gloss);
    }
  }
  if (known.known) tell_in_units(known, sample.smooth, sample);
}

// Does the same if that surface is Lambertian: one lobe and no gloss.
void shade_first_lambert(const Transport& transport, const WalkRules& rules, Walk& walk,
                         const Hit& hit, Sampler& sampler, Sample& sample) {
  LambertSurface surface = eval_lambert_surface(transport.world, walk.ray, hit);
  describe_place(transport.world, hit, surface, surface.normal, hit.t, sample);
  sample.flags |= sample_sure;
  if (rules.max_depth < 2) return;
  LambertLobe lobe = make_lambert(surface, walk.ray.direction);
  if (!(max_component(lobe.reflectance) > least_albedo)) return;
  sample.albedo = lobe.reflectance * eval_absorption(transport, walk.media.here.innermost(), hit.t);
  KnownLight known;
  if (walk.media.here.count == 0)
    known = find_known_light(transport, walk.ray, hit, surface.position);
  if (known.known && rules.reads_maps && !may_be_shaded(transport, surface.position))
    return tell_in_units(known, known.light, sample);
  const uint32_t base = Dimensions::first_surface;
  reflect(transport, hit, base, sampler, walk.wavelengths);
  sampler.seek(base);
  DirectLight direct = sample_direct_light(transport, walk, surface, lobe, true, sampler);
  sample.smooth += direct.area_diffuse;
  if (known.known) sample.smooth += direct.punctual_diffuse;
  else sample.rest += sample.albedo * direct.punctual_diffuse;
  if (!direct.sure_of_punctual()) sample.flags &= uint8_t(~sample_sure);
  sampler.seek(base + Dimensions::scatter + 1);
  BsdfSample scattered = sample_lambert(lobe, sampler.next2());
  if (scattered.pdf > 0) scattered.weight = vec3(1);
  if (advance(walk, surface, scattered)) {
    walk.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
    sampler.seek(Dimensions::walk);
    sample.smooth += follow(transport, rules, walk, sampler);
  }
  if (known.known) tell_in_units(known, sample.smooth, sample);
}

}  // namespace

Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request) {
  if (rules.max_depth < 1) return {};
  return trace_sample(transport, rules, request, transport.world.intersect(request.ray));
}

Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request,
                    const Hit& hit) {
  Sampler sampler(request.seed, request.index);
  Sample sample;
  Walk walk = begin_walk(transport, request);
  const bool simple = !hit.valid() || met_lambertian(transport, hit);
  if (simple && see_volume(transport, walk, hit.t, vec3(1), 0, sample)) return sample;
  if (!hit.valid()) {
    describe_sky(transport, walk.ray.direction, vec3(1), sample);
    sample.flags |= sample_sure;
    return sample;
  }
  if (simple) {
    shade_first_lambert(transport, rules, walk, hit, sampler, sample);
    return sample;
  }
  FirstSurface first = find_first_surface(transport, rules.max_depth, walk, hit, sampler, sample);
  if (!first.by_chance) sample.flags |= sample_sure;  // until chance comes in
  if (first.scatters) shade_first(transport, rules, first, sampler, sample);
  if (first.mirrored) {
    sample.flags &= uint8_t(~sample_sure);
    sampler.seek(3 * Dimensions::walk);
    sample.rest += follow(transport, rules, first.reflection, sampler);
  }
  return sample;
}

}  // namespace wellspring::light
