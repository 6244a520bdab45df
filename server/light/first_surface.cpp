// SPDX-License-Identifier: Apache-2.0
#include "light/first_surface.h"

namespace wellspring {
namespace {

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

}  // namespace

FirstSurface find_first_surface(const Transport& transport, int max_depth, const Request& request,
                                Sampler& sampler, Sample& sample) {
  const World& world = transport.world;
  FirstSurface first;
  Walk& walk = first.walk;
  walk.ray = request.ray;
  if (transport.tables.any_solid) walk.media.here = find_media(transport, walk.ray.origin);
  float distance = 0, reflections = 0;
  while (true) {
    Hit hit = world.intersect(walk.ray);
    if (!hit.valid()) {
      sample.position = request.ray.direction;
      sample.distance = std::numeric_limits<float>::infinity();
      sample.rest =
          first.tint * eval_environment(transport.tables.environment, request.ray.direction);
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
      sample.rest += first.tint * surface.emission;
      if (max_depth > 1)
        add_reflection(first, reflections, surface, eval_mirror(bsdf), sampler);
      BsdfSample straight;
      straight.direction = walk.ray.direction;
      straight.weight = vec3(1);
      straight.bounce = Bounce::pass;
      first.tint *= pane_transmittance(surface, material, walk.ray.direction);
      advance(walk, surface, straight);
      continue;
    }
    describe(world, walk.ray, surface, distance, sample);
    sample.rest += first.tint * surface_emission(surface, material);
    first.scatters = !material.unlit && max_depth > 1;
    break;
  }
  first.mirrored = reflections > 0;
  first.reflection.throughput *= reflections;
  return first;
}

}  // namespace wellspring
