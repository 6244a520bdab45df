// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake_scene.h"

#include <algorithm>
#include <cmath>

#include "light/material/bsdf_gloss.h"
#include "light/random/warp.h"
#include "light/sample/light_tables.h"
#include "light/walk/known_light.h"

namespace wellspring::light {
namespace {

// Path edges at most, and edges that roulette never cuts.
constexpr int most_depth = 12, certain_depth = 4;
constexpr int most_steps = 64;  // steps of a walk, panes passed straight included

// Returns whether a ray meets something opaque with one side from behind, so from within.
bool meets_inside(const World& world, const Ray& ray, const Hit& hit) {
  const Material& m = world.material_of(hit.instance);
  if (m.double_sided || m.transmission > 0 || m.alpha_mode != AlphaMode::opaque) return false;
  return dot(eval_face(world, hit.instance, hit.triangle), ray.direction) > 0;
}

}  // namespace

// The ray on the opposite side of the normal must meet the inside of something, too: otherwise the
// hit may be the back of a sheet that somebody forgot to give two sides.
bool is_inside(const World& world, const Walk& walk, const Hit& met) {
  if (!met.valid() || !meets_inside(world, walk.ray, met)) return false;
  Ray other = walk.ray;
  float up = dot(walk.ray.direction, walk.from_normal);
  other.direction = 2 * up * walk.from_normal - walk.ray.direction;
  Hit hit = world.intersect(other);
  return hit.valid() && meets_inside(world, other, hit);
}

BakeScene make_bake_scene_of_paths(const World& world) {
  const Scene& scene = world.scene();
  BakeScene bake{world, make_lights(world), {}, {}, find_lamp_parts(scene), {}};
  if (scene.lamps.empty()) bake.tables = {bake.lights.tables};
  else bake.tables = make_lamp_tables(*bake.lights.tables, scene);
  for (const auto& tables : bake.tables) bake.parts.push_back({world, *tables});
  return bake;
}

// Returns the chart of the surface that the walk met, if there is coarse light on it.
static uint32_t find_known_chart(const BakeScene& scene, const Walk& walk, const Hit& hit) {
  if (!scene.known || walk.media.here.count > 0) return no_chart;
  return find_chart(*scene.known->places, scene.world, walk.ray, hit);
}

static void add_known_light(const BakeScene& scene, uint32_t number, const Ray& ray, const Hit& hit,
                            const Surface& surface, vec3 weight, std::span<vec3> light) {
  const IlluminationMap& map = *scene.known;
  const IlluminationChart& chart = map.places->charts[number];
  const IlluminationTaps taps = find_taps(map, chart, surface.position);
  const vec3 mesh = chart.sloped ? eval_mesh_normal(scene.world, ray, hit) : surface.normal;
  for (size_t p = 0; p < light.size(); p++) {
    const IlluminationNodes& nodes = (*map.layers)[p];
    const vec3 found = eval_illumination(nodes, taps);
    if (found == vec3(0)) continue;
    light[p] +=
        eval_illumination_turn(map, nodes, chart, taps, mesh, surface.normal) * weight * found;
  }
}

void add_met_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                   bool& inside) {
  const World& world = scene.world;
  const Transport& any = scene.parts.front();
  auto weigh_for = [&](size_t part) {
    walk.area_share = scene.parts[part].tables.area_share > 0 ? 1.0f : 0.0f;
  };
  for (int step = 0; step < most_steps; step++) {
    Hit hit = world.intersect(walk.ray);
    if (step == 0 && hit.valid() && is_inside(world, walk, hit)) {
      inside = true;
      return;
    }
    if (ends_in_volume(any, walk, hit.t, light[0])) return;
    if (!hit.valid()) {
      weigh_for(0);
      light[0] += walk.throughput * walk_met_sky(any, walk);
      return;
    }
    const Material& material = world.material_of(hit.instance);
    if (material.emission == vec3(0) && material.transmission == 0) return;
    const Surface surface = meet_surface(any, walk.ray, hit, walk.media);
    walk.throughput *= eval_absorption(any, walk.media.here.innermost(), hit.t);
    const size_t own = scene.part_of[size_t(world.mesh_of(hit.instance).material)];
    weigh_for(own);
    light[own] += walk.throughput * walk_met_emission(scene.parts[own], walk, surface, material);
    if (material.unlit || material.transmission == 0) return;
    const Bsdf bsdf = make_bsdf_in(any, walk.media, surface, material, walk.ray.direction);
    sampler.seek(Dimensions::walk + uint32_t(step) * Dimensions::surface + Dimensions::scatter);
    const BsdfSample scattered = sample_bsdf(bsdf, Lobes::all, sampler);
    if (scattered.bounce != Bounce::pass || !advance(walk, surface, scattered)) return;
  }
}

void gather_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                  bool& inside) {
  const World& world = scene.world;
  const Transport& any = scene.parts.front();
  // Sources that are met before anything scatters the light belong to add_met_light().
  bool sampled = true, scattered_once = false;
  auto weigh_for = [&](size_t part) {
    walk.area_share = sampled ? scene.parts[part].tables.area_share : 0;
  };
  for (int step = 0; step < most_steps; step++) {
    const uint32_t base = Dimensions::walk + uint32_t(step) * Dimensions::surface;
    Hit hit = world.intersect(walk.ray);
    if (step == 0 && hit.valid() && is_inside(world, walk, hit)) {
      inside = true;
      return;
    }
    vec3 of_volume(0);
    const bool ends = ends_in_volume(any, walk, hit.t, of_volume);
    if (scattered_once) light[0] += of_volume;
    if (ends) return;
    if (!hit.valid()) {
      if (!scattered_once) return;
      weigh_for(0);
      light[0] += walk.throughput * walk_met_sky(any, walk);
      return;
    }
    Surface surface = meet_surface(any, walk.ray, hit, walk.media);
    const Material& material = world.material_of(hit.instance);
    walk.throughput *= eval_absorption(any, walk.media.here.innermost(), hit.t);
    const size_t own = scene.part_of[size_t(world.mesh_of(hit.instance).material)];
    if (scattered_once) {
      weigh_for(own);
      light[own] += walk.throughput * walk_met_emission(scene.parts[own], walk, surface, material);
    }
    if (material.unlit || walk.depth >= most_depth) return;
    Bsdf bsdf = make_bsdf_in(any, walk.media, surface, material, walk.ray.direction);
    Lobes goes_on = Lobes::all;
    if (const uint32_t chart = find_known_chart(scene, walk, hit); chart != no_chart) {
      add_known_light(scene, chart, walk.ray, hit, surface,
                      walk.throughput * kept_reflectance(bsdf), light);
      if (!has_sharp_gloss(bsdf)) return;
      goes_on = Lobes::specular;
    } else if (!is_smooth(bsdf)) {
      for (size_t p = 0; p < light.size(); p++) {
        sampler.seek(base);
        light[p] += walk.throughput *
                    sample_direct_light(scene.parts[p], walk, surface, bsdf, false, sampler).sum();
      }
    }
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, goes_on, sampler);
    if (!advance(walk, surface, scattered)) return;
    if (scattered.bounce != Bounce::pass) {
      sampled = scattered.pdf > 0 && goes_on == Lobes::all;
      scattered_once = true;
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

}  // namespace wellspring::light
