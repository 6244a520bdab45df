// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "light/walk.h"

namespace wellspring {
namespace {

// What stands between the eye and the first surface that is no clear pane, and one of the panes'
// mirror images, chosen by how bright it may be.
struct Foreground {
  vec3 tint{1};
  Walk reflection;        // its throughput is already divided by the chance of the choice
  float reflections = 0;  // sum of what the panes reflect
  bool any() const { return reflections > 0; }
};

void add_reflection(Foreground& foreground, const Surface& surface, const BsdfSample& mirrored,
                    const Walk& walk, Sampler& sampler) {
  vec3 weight = foreground.tint * mirrored.weight;
  float strength = max_component(weight);
  if (!(strength > 0)) return;
  foreground.reflections += strength;
  if (sampler.next() * foreground.reflections >= strength) return;
  foreground.reflection = walk;
  foreground.reflection.throughput = vec3(1);
  BsdfSample unit = mirrored;
  unit.weight = weight / strength;
  advance(foreground.reflection, surface, unit);
}

void describe(const World& world, const Ray& ray, const Surface& surface, float distance,
              Sample& sample) {
  sample.position = surface.position;
  sample.normal = surface.normal;
  sample.distance = distance;
  sample.object = surface.object;
  sample.instance = surface.instance;
  sample.triangle = surface.triangle;
  sample.barycentric = surface.barycentric;
  sample.flags = uint8_t(sample_hit | (world.is_moving(surface.instance) ? sample_moving : 0));
}

// Mirrors, glass and polished metal: what is seen there moves with the view.
bool looks_specular(const Bsdf& bsdf) { return bsdf.alpha < 0.1f && bsdf.diffuse_share < 0.5f; }

constexpr float soft_alpha = 0.12f;  // roughness 0.35

// The first surface's light, its diffuse lobe (of reflectance 1) and its specular lobes sampled
// apart.
void shade_first(const Transport& transport, const WalkRules& rules, const Walk& walk,
                 const Surface& surface, Bsdf& bsdf, vec3 tint, Sampler& sampler, Sample& sample) {
  bool diffuse = max_component(bsdf.diffuse) > 1e-4f;
  vec3 albedo = diffuse ? bsdf.diffuse : bsdf.metallic * bsdf.metal;
  // Rough gloss looks nearly the same from everywhere: as a share of the reflectance it may be filtered with
  // the diffuse light.
  bool soft = bsdf.alpha >= soft_alpha && !(max_component(bsdf.transmit) > 0) &&
              std::min({albedo.x, albedo.y, albedo.z}) > 0.02f;
  if (!diffuse && !soft) albedo = vec3(0);
  auto add_gloss = [&](vec3 light) {
    if (soft) sample.smooth += light / albedo;
    else sample.rest += tint * light;
  };
  bsdf.diffuse = diffuse ? vec3(1) : vec3(0);
  sample.albedo = albedo * tint;
  if (looks_specular(bsdf)) sample.flags |= sample_specular;
  if (!is_smooth(bsdf)) {
    DirectLight direct = sample_direct_light(transport, walk, surface, bsdf, true, sampler);
    sample.smooth += walk.throughput * direct.area_diffuse;
    sample.rest += tint * walk.throughput * albedo * direct.punctual_diffuse;
    add_gloss(walk.throughput * direct.specular);
  }
  if (diffuse) {
    Walk next = walk;
    next.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (advance(next, surface, sample_bsdf(bsdf, Lobes::diffuse, sampler)))
      sample.smooth += follow(transport, rules, next, sampler);
  }
  // A faint gloss over a diffuse layer is followed now and then, a strong one each time.
  float chance = diffuse ? glm::clamp(4 * (1 - bsdf.diffuse_share), 0.25f, 1.0f) : 1.0f;
  if (has_specular(bsdf) && (chance == 1 || sampler.next() < chance)) {
    Walk next = walk;
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::specular, sampler);
    scattered.weight /= chance;
    next.area_share = scattered.pdf > 0 && transport.tables.area_share > 0 ? 1.0f : 0.0f;
    if (scattered.bounce == Bounce::refract) next.density *= bsdf.eta * bsdf.eta;
    if (advance(next, surface, scattered))
      sample.rest += tint * follow(transport, rules, next, sampler);
  }
}

}  // namespace

Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request) {
  const World& world = transport.world;
  Sampler sampler(request.seed, request.index);
  Sample sample;
  if (rules.max_depth < 1) return sample;
  Walk walk;
  walk.ray = request.ray;
  Foreground foreground;
  float distance = 0;
  while (true) {
    Hit hit = world.intersect(walk.ray);
    if (!hit.valid()) {
      sample.position = request.ray.direction;
      sample.distance = std::numeric_limits<float>::infinity();
      sample.rest =
          foreground.tint * eval_environment(transport.tables.environment, request.ray.direction);
      break;
    }
    Surface surface = eval_surface(world, walk.ray, hit);
    const Material& material = world.material_of(hit.instance);
    distance += hit.t;
    walk.medium = medium_before(walk, surface, material);
    vec3 absorption = eval_absorption(transport, walk.medium, hit.t);
    foreground.tint *= absorption;
    Bsdf bsdf = make_bsdf(surface, material, walk.ray.direction,
                          *transport.tables.materials[size_t(surface.material)].albedo);
    bool clear =
        is_pane(surface, material) && !has_diffuse(bsdf) && bsdf.metallic == 0 && !material.unlit;
    if (clear && walk.panes < most_panes) {
      sample.rest += foreground.tint * surface.emission;
      if (rules.max_depth > 1)
        add_reflection(foreground, surface, eval_mirror(bsdf), walk, sampler);
      BsdfSample straight;
      straight.direction = walk.ray.direction;
      straight.weight = vec3(1);
      straight.bounce = Bounce::pass;
      foreground.tint *= pane_transmittance(surface, material, walk.ray.direction);
      advance(walk, surface, straight);
      continue;
    }
    describe(world, walk.ray, surface, distance, sample);
    sample.rest += foreground.tint * surface_emission(surface, material);
    if (!material.unlit && rules.max_depth > 1)
      shade_first(transport, rules, walk, surface, bsdf, foreground.tint, sampler, sample);
    break;
  }
  if (foreground.any()) {
    Walk reflection = foreground.reflection;
    reflection.throughput *= foreground.reflections;
    sample.rest += follow(transport, rules, reflection, sampler);
  }
  return sample;
}

}  // namespace wellspring
