// SPDX-License-Identifier: Apache-2.0
#include "light/bake/bake_scene.h"

#include <algorithm>
#include <cmath>

#include "light/known/fill_radiance_grid.h"
#include "light/random/warp.h"
#include "light/sample/light_tables.h"
#include "light/sample/radiance_grid.h"

namespace wellspring {
namespace {

constexpr int most_depth = 12, certain_depth = 4;  // edges; those that roulette never cuts
constexpr int most_steps = 64;                     // panes passed straight included

// Behind a face of something opaque with one side: within it.
bool meets_inside(const World& world, const Ray& ray, const Hit& hit) {
  const Material& m = world.material_of(hit.instance);
  if (m.double_sided || m.transmission > 0 || m.alpha_mode != AlphaMode::opaque) return false;
  return dot(eval_face(world, hit.instance, hit.triangle), ray.direction) > 0;
}

}  // namespace

// A ray opposite the one that met the inside of something must do so, too: else that may be the
// back of a sheet that somebody forgot to give two sides.
bool is_inside(const World& world, const Walk& walk, const Hit& met) {
  if (!met.valid() || !meets_inside(world, walk.ray, met)) return false;
  Ray other = walk.ray;
  float up = dot(walk.ray.direction, walk.from_normal);
  other.direction = 2 * up * walk.from_normal - walk.ray.direction;
  Hit hit = world.intersect(other);
  return hit.valid() && meets_inside(world, other, hit);
}

static void set_parts(BakeScene& bake) {
  for (const auto& tables : bake.tables)
    bake.parts.push_back({bake.world, *tables, bake.lights.grid.get(),
                          bake.lights.grid ? bake.lights.grid->lamps.get() : nullptr});
}

static BakeScene make_lamp_parts(const World& world) {
  const Scene& scene = world.scene();
  BakeScene bake{world, make_lights(world), {}, {}, find_lamp_parts(scene), {}};
  if (scene.lamps.empty()) bake.tables = {bake.lights.tables};
  else bake.tables = make_lamp_tables(*bake.lights.tables, scene);
  return bake;
}

BakeScene make_bake_scene_of_paths(const World& world) {
  BakeScene bake = make_lamp_parts(world);
  set_parts(bake);
  return bake;
}

BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          std::shared_ptr<const RadianceGrid> grid) {
  BakeScene bake = make_lamp_parts(world);
  const bool parted = grid && grid->parts && grid->parts->light.size() == bake.tables.size();
  if (!parted && !places.empty() && bake.lights.tables->plan.uses(TransportPart::cached_radiance))
    grid = make_radiance_grid({world, *bake.lights.tables}, places, {}, bake.tables);
  else if (!parted) grid = nullptr;
  bake.lights.grid = grid;
  if (grid) {
    bake.number_of.assign(grid->keys.size(), 0);
    for (size_t i = 0; i < grid->parts->slots.size(); i++)
      bake.number_of[grid->parts->slots[i]] = uint32_t(i);
  }
  set_parts(bake);
  return bake;
}

void gather_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                  bool& inside) {
  const World& world = scene.world;
  const Transport& any = scene.parts.front();
  bool sampled = true, apart = true;  // area light, where the ray left
  auto weigh_for = [&](size_t part) {
    float share = scene.parts[part].tables.area_share;
    walk.area_share = !sampled ? 0 : apart && share > 0 ? 1 : share;
  };
  for (int step = 0; step < most_steps; step++) {
    const uint32_t base = Dimensions::walk + uint32_t(step) * Dimensions::surface;
    Hit hit = world.intersect(walk.ray);
    if (!hit.valid()) {
      weigh_for(0);
      light[0] += walk.throughput * walk_met_sky(any, walk);
      return;
    }
    if (step == 0 && is_inside(world, walk, hit)) {
      inside = true;
      return;
    }
    vec3 kept;
    if (any.grid && walk.pdf > 0 && walk.media.here.count == 0 &&
        eval_grid(*any.grid, world, walk.ray, hit, hit.t / std::sqrt(walk.pdf), kept)) {
      vec3 normal = eval_face(world, hit.instance, hit.triangle);
      if (dot(normal, walk.ray.direction) > 0) normal = -normal;
      uint32_t slot =
          find_grid_slot(*any.grid, walk.ray.origin + hit.t * walk.ray.direction, normal);
      for (size_t p = 0; p < light.size(); p++)
        light[p] += walk.throughput * any.grid->parts->light[p][scene.number_of[slot]];
      return;
    }
    Surface surface = meet_surface(any, walk.ray, hit, walk.media);
    const Material& material = world.material_of(hit.instance);
    walk.throughput *= eval_absorption(any, walk.media.here.innermost(), hit.t);
    const size_t own = scene.part_of[size_t(world.mesh_of(hit.instance).material)];
    weigh_for(own);
    light[own] += walk.throughput * walk_met_emission(scene.parts[own], walk, surface, material);
    if (material.unlit || walk.depth >= most_depth) return;
    Bsdf bsdf = make_bsdf_in(any, walk.media, surface, material, walk.ray.direction);
    if (!is_smooth(bsdf))
      for (size_t p = 0; p < light.size(); p++) {
        sampler.seek(base);
        light[p] += walk.throughput *
                    sample_direct_light(scene.parts[p], walk, surface, bsdf, false, sampler).sum();
      }
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, Lobes::all, sampler);
    if (!advance(walk, surface, scattered)) return;
    if (scattered.bounce != Bounce::pass) {
      sampled = scattered.pdf > 0;
      apart = false;
      walk.from_normal = lit_side(surface, bsdf);
    }
    if (scattered.bounce == Bounce::refract) walk.density *= bsdf.eta * bsdf.eta;
    if (walk.edges() <= certain_depth) continue;
    float chance = std::min(0.95f, max_component(walk.throughput) * walk.density);
    sampler.seek(base + Dimensions::survival);
    if (!(sampler.next() < chance)) return;
    walk.throughput /= chance;
  }
}

}  // namespace wellspring
