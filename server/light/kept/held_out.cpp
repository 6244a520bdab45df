// SPDX-License-Identifier: Apache-2.0
#include "light/kept/held_out.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/walk/known_light.h"

namespace wellspring::light {
namespace {

constexpr float least_facing = 0.05f;  // cosine between a node's normal and a face of it
constexpr float least_passing = 0.05f;
constexpr float most_brightness = 25;  // bound of a gathered sample, times the mean light

BakePlace light_surface(const BakeScene& scene, const Ray& ray, const Hit& hit,
                        const Surface& surface) {
  BakePlace lit;
  lit.surface = surface;
  const Material& material = scene.world.material_of(hit.instance);
  lit.bsdf = make_bsdf_in(scene.parts.front(), Media{}, lit.surface, material, ray.direction);
  lit.bsdf.diffuse = vec3(1);
  const float passes = lit.bsdf.coat_passes * lit.bsdf.beneath;
  lit.uncoated = passes > least_passing ? 1 / passes : 1;
  return lit;
}

}  // namespace

BakePlace light_seen_place(const BakeScene& scene, const Ray& ray, const Hit& hit) {
  return light_surface(scene, ray, hit, eval_surface(scene.world, ray, hit));
}

BakePlace light_node_place(const BakeScene& scene, const Ray& ray, const Hit& hit, vec3 normal) {
  Surface surface = eval_surface(scene.world, ray, hit);
  const bool faces = dot(normal, surface.geometric_normal) > least_facing;
  surface.normal = faces ? normal : eval_mesh_normal(scene.world, ray, hit);
  return light_surface(scene, ray, hit, surface);
}

bool leave(const BakePlace& lit, Sampler& sampler, Walk& walk) {
  sampler.seek(Dimensions::first_surface + Dimensions::scatter);
  BsdfSample scattered = sample_bsdf(lit.bsdf, Lobes::diffuse, sampler);
  if (!advance(walk, lit.surface, scattered)) return false;
  walk.from_normal = lit.surface.geometric_normal;
  return true;
}

void cut_off(const BakeScene& scene, std::span<vec3> light) {
  if (!scene.known) return;
  const float most = most_brightness * scene.known->mean;
  vec3 sum(0);
  add_color(scene.plain_colors(), light, sum);
  if (!(luminance(sum) > most)) return;
  for (vec3& l : light) l *= most / luminance(sum);
}

namespace {

// Tangent of 30 degrees: eyes look level, and up and down as far as that.
constexpr float most_rise = 0.577f;
constexpr size_t tries_a_place = 4;  // tries for each place, until some surface has a chart there
constexpr uint64_t places_seed = 0x68656c64, samples_seed = 0x6f7574;

// Describes a place; returns false if no chart is there.
bool describe(const World& world, const IlluminationCharts& charts, HeldOutPlace& place) {
  place.chart = find_chart(charts, world, place.ray, place.hit);
  if (place.chart == no_chart) return false;
  const Surface surface = eval_surface(world, place.ray, place.hit);
  place.position = surface.position;
  place.mesh = eval_mesh_normal(world, place.ray, place.hit), place.seen = surface.normal;
  return true;
}

Ray look_about(vec3 eye, Sampler& sampler) {
  const vec2 u = sampler.next2();
  const float turn = 2 * pi * u.x;
  Ray ray;
  ray.origin = eye;
  ray.direction = normalize(vec3(std::cos(turn), most_rise * (2 * u.y - 1), std::sin(turn)));
  return ray;
}

// Returns the areas of all charts' triangles, added up.
std::vector<double> sum_areas(const World& world, const BakeCharts& charts) {
  std::vector<double> sums;
  double sum = 0;
  for (const ChartSurface& surface : charts.surfaces)
    for (uint32_t i = 0; i < surface.count; i++) {
      float area = 0;
      eval_face(world, surface.instance, charts.triangles[surface.first + i], &area);
      sums.push_back(sum += double(area));
    }
  return sums;
}

// Looks at a place of a chart's triangle along its normal.
void look_at(const World& world, const BakeCharts& charts, size_t triangle, vec2 u,
             HeldOutPlace& place) {
  const auto surface = std::upper_bound(
      charts.surfaces.begin(), charts.surfaces.end(), triangle,
      [](size_t at, const ChartSurface& s) { return at < size_t(s.first) + s.count; });
  const float root = std::sqrt(u.x);
  place.hit.instance = surface->instance, place.hit.triangle = charts.triangles[triangle];
  place.hit.barycentric = {root * (1 - u.y), root * u.y};
  place.hit.t = 1;
  const vec3 normal = eval_face(world, place.hit.instance, place.hit.triangle);
  place.ray.direction = surface->back ? normal : -normal;
  place.ray.origin =
      eval_position(world, place.hit.instance, place.hit.triangle, place.hit.barycentric) -
      place.ray.direction;
}

float sample_place(const BakeScene& scene, const HeldOutPlace& place, Sampler& sampler,
                   std::vector<vec3>& gathered) {
  const BakePlace lit = light_seen_place(scene, place.ray, place.hit);
  const Transport all{scene.world, *scene.lights.tables};
  sampler.seek(Dimensions::first_surface);
  const DirectLight direct = sample_direct_light(all, Walk{}, lit.surface, lit.bsdf, true, sampler);
  vec3 light = direct.area_diffuse + direct.punctual_diffuse;
  const std::vector<mat3>& colors =
      scene.colors.on(scene.world.material_of(place.hit.instance).spectra.reflectance);
  std::fill(gathered.begin(), gathered.end(), vec3(0));
  Walk walk;
  bool inside = false;
  if (leave(lit, sampler, walk)) {
    add_met_light(scene, walk, sampler, gathered, inside);
    add_color(colors, gathered, light);
    std::ranges::fill(gathered, vec3(0));
    gather_light(scene, walk, sampler, gathered, inside);
    cut_off(scene, gathered);
  }
  add_color(colors, gathered, light);
  const float found = lit.uncoated * luminance(light);
  return std::isfinite(found) ? found : 0;
}

}  // namespace

HeldOut hold_out(const World& world, const BakeCharts& charts, std::span<const vec3> eyes,
                 size_t count, uint64_t seed) {
  HeldOut held;
  const std::vector<double> areas = eyes.empty() ? sum_areas(world, charts) : std::vector<double>();
  if (charts.tiles == 0) return held;
  for (size_t i = 0; i < tries_a_place * count && held.places.size() < count; i++) {
    Sampler sampler(mix64(seed + places_seed), uint32_t(i));
    HeldOutPlace place;
    if (eyes.empty()) {
      const double sought = double(sampler.next()) * areas.back();
      const auto at = std::upper_bound(areas.begin(), areas.end() - 1, sought);
      look_at(world, charts, size_t(at - areas.begin()), sampler.next2(), place);
    } else {
      place.ray = look_about(eyes[i % eyes.size()], sampler);
      place.hit = world.intersect(place.ray);
      if (!place.hit.valid()) continue;
    }
    if (describe(world, *charts.places, place)) held.places.push_back(place);
  }
  return held;
}

bool restore(const World& world, const IlluminationCharts& charts, HeldOut& held) {
  auto is_of_world = [&](HeldOutPlace& place) {
    const Hit& hit = place.hit;
    const vec2 b = hit.barycentric;
    return hit.instance < world.scene().instances.size() &&
           hit.triangle < world.mesh_of(hit.instance).triangles.size() && b.x >= 0 && b.y >= 0 &&
           b.x + b.y <= 1.001f && is_finite(place.ray.origin) && is_finite(place.ray.direction) &&
           std::isfinite(place.half[0]) && std::isfinite(place.half[1]) &&
           describe(world, charts, place);
  };
  return std::all_of(held.places.begin(), held.places.end(), is_of_world);
}

void sample_held_out(const BakeScene& scene, int samples, HeldOut& held) {
  parallel_for(int(held.places.size()), [&](int i) {
    HeldOutPlace& place = held.places[size_t(i)];
    std::vector<vec3> gathered(scene.layers());
    for (uint64_t half = 0; half < 2; half++)
      for (uint32_t k = 0; k < uint32_t(samples); k++) {
        Sampler sampler(mix64(samples_seed + 2 * uint64_t(i) + half), held.samples + k);
        place.half[half] += sample_place(scene, place, sampler, gathered);
      }
  });
  held.samples += uint32_t(samples);
}

float held_out_error(const HeldOut& held, const IlluminationMap& map) {
  const double count = double(held.places.size());
  if (held.samples == 0 || count == 0) return 1;
  double light = 0, sum = 0, squares = 0;
  for (const HeldOutPlace& place : held.places) {
    const IlluminationChart& chart = map.places->charts[place.chart];
    const IlluminationTaps taps = find_taps(map, chart, place.position);
    const double known =
        double(luminance(eval_illumination(map.nodes, taps))) *
        double(eval_illumination_turn(map, map.nodes, chart, taps, place.mesh, place.seen));
    const double a = double(place.half[0]) / held.samples, b = double(place.half[1]) / held.samples,
                 square = (a - known) * (b - known);
    light += 0.5 * (a + b), sum += square, squares += square * square;
  }
  const double mean = sum / count,
               deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
  if (!(light > 0)) return sum > 0 ? 1 : 0;
  return float(std::sqrt(std::max(mean, 0.0) + deviation) / (light / count));
}

}  // namespace wellspring::light
