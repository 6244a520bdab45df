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
  BakeScene bake{world, make_lights(world)};
  bake.part_of = find_lamp_parts(scene);
  bake.bins = make_walk_bins(scene);
  bake.colors = find_layer_colors(scene);
  if (scene.lamps.empty()) bake.tables = {bake.lights.tables};
  else bake.tables = make_lamp_tables(*bake.lights.tables, scene);
  for (const auto& tables : bake.tables) bake.parts.push_back({world, *tables});
  const std::vector<MapLayer> layers = find_layers(scene);
  for (size_t l = 0; l < layers.size(); l++) {
    if (layers[l].bin > 0) continue;
    bake.first_layer.push_back(l);
    bake.lamp_color.push_back(layers[l].lamp < 0 ? vec3(1) : binned_color(scene, layers[l].lamp));
  }
  bake.first_layer.push_back(layers.size());
  return bake;
}

void add_color(std::span<const mat3> colors, std::span<const vec3> light, vec3& sum) {
  for (size_t l = 0; l < light.size(); l++) sum += colors[l] * light[l];
}

// Returns the chart of the surface that the walk met, if there is coarse light on it.
static uint32_t find_known_chart(const BakeScene& scene, const Walk& walk, const Hit& hit) {
  if (!scene.known || walk.media.here.count > 0) return no_chart;
  return find_chart(*scene.known->places, scene.world, walk.ray, hit);
}

// `weight`: the walk's throughput times what the surface reflects, of colours.
static void add_known_light(const BakeScene& scene, uint32_t number, const Ray& ray, const Hit& hit,
                            const Surface& surface, vec3 weight, const BinnedWalk& binned,
                            std::span<vec3> light) {
  const IlluminationMap& map = *scene.known;
  const IlluminationChart& chart = map.places->charts[number];
  const IlluminationTaps taps = find_taps(map, chart, surface.position);
  const vec3 mesh = chart.sloped ? eval_mesh_normal(scene.world, ray, hit) : surface.normal;
  const std::vector<mat3>& colors = scene.colors.on(chart.reflectance);
  auto add = [&](size_t l, const auto& weight_of) {
    const IlluminationNodes& nodes = (*map.layers)[l];
    const vec3 found = eval_illumination(nodes, taps);
    if (found == vec3(0)) return;
    light[l] +=
        eval_illumination_turn(map, nodes, chart, taps, mesh, surface.normal) * weight_of() * found;
  };
  for (size_t p = 0; p < scene.parts.size(); p++)
    for (size_t first = scene.first_layer[p], l = first; l < scene.first_layer[p + 1]; l++)
      add(l, [&] { return scene.has_bins(p) ? binned.diffuse(l - first) : colors[l] * weight; });
}

// Adds light of a part whose last way was the walk's next ray.
static void add_arriving(const BakeScene& scene, size_t part, vec3 color, const Walk& walk,
                         const BinnedWalk& binned, std::span<vec3> light) {
  const size_t first = scene.first_layer[part];
  if (!scene.has_bins(part)) light[first] += walk.throughput * color;
  else
    for (size_t l = 0; l < bin_layers; l++)
      light[first + l] += binned.arriving(l, color / scene.lamp_color[part]);
}

// Adds light of a part that the surface which the walk has met sends on.
static void add_direct(const BakeScene& scene, size_t part, const DirectLight& direct,
                       const Walk& walk, const BinnedWalk& binned, std::span<vec3> light) {
  const size_t first = scene.first_layer[part];
  if (!scene.has_bins(part)) {
    light[first] += walk.throughput * direct.sum();
    return;
  }
  auto add = [&](vec3 arrives, vec3 direction) {
    if (arrives == vec3(0)) return;
    for (size_t l = 0; l < bin_layers; l++)
      light[first + l] += binned.sent_on(l, arrives / scene.lamp_color[part], direction);
  };
  add(direct.area_arrives, direct.area_direction);
  add(direct.punctual_arrives, direct.punctual_direction);
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
    for_each_layer(scene, own,
                   walk.throughput * walk_met_emission(scene.parts[own], walk, surface, material),
                   [&](size_t l, vec3 found) { light[l] += found; });
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
  BinnedWalk binned(scene.bins.get());
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
    const int medium = walk.media.here.innermost();
    const vec3 tint = eval_absorption(any, medium, hit.t);
    walk.throughput *= tint;
    if (binned.is_followed() && tint != vec3(1))
      binned.absorb(world.scene().materials[size_t(medium)], tint, hit.t);
    const size_t own = scene.part_of[size_t(world.mesh_of(hit.instance).material)];
    if (scattered_once) {
      weigh_for(own);
      add_arriving(scene, own, walk_met_emission(scene.parts[own], walk, surface, material), walk,
                   binned, light);
    }
    if (material.unlit || walk.depth >= most_depth) return;
    Bsdf bsdf = make_bsdf_in(any, walk.media, surface, material, walk.ray.direction);
    if (binned.is_followed()) binned.meet(any, walk, surface, material, bsdf);
    Lobes goes_on = Lobes::all;
    if (const uint32_t chart = find_known_chart(scene, walk, hit); chart != no_chart) {
      add_known_light(scene, chart, walk.ray, hit, surface,
                      walk.throughput * kept_reflectance(bsdf), binned, light);
      if (!has_sharp_gloss(bsdf)) return;
      goes_on = Lobes::specular;
    } else if (!is_smooth(bsdf)) {
      for (size_t p = 0; p < scene.parts.size(); p++) {
        sampler.seek(base);
        add_direct(scene, p,
                   sample_direct_light(scene.parts[p], walk, surface, bsdf, false, sampler), walk,
                   binned, light);
      }
    }
    sampler.seek(base + Dimensions::scatter);
    BsdfSample scattered = sample_bsdf(bsdf, goes_on, sampler);
    if (!advance(walk, surface, scattered)) return;
    if (binned.is_followed()) binned.scatter(scattered, goes_on);
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
    binned.divide(chance);
  }
}

}  // namespace wellspring::light
