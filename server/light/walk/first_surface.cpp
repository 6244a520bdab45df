// SPDX-License-Identifier: Apache-2.0
#include "light/walk/first_surface.h"

#include <algorithm>

#include "light/material/bsdf_frame.h"

namespace wellspring::light {
namespace {

constexpr float soft_alpha = least_soft_roughness * least_soft_roughness;

// One mirror image of those of all panes: `reflections` is the sum of what they reflect.
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

// What a surface emits is light of the sample like any other, and told by itself.
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

}  // namespace wellspring::light
