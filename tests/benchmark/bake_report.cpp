// SPDX-License-Identifier: Apache-2.0
// bake.*: illumination maps against converged `path`, by time.
#include <algorithm>
#include <cmath>

#include "bake_particles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "light/kept/finish_bake.h"
#include "light/material/bsdf.h"
#include "light/walk/known_light.h"
#include "light_scenes.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/exhibit/exhibit_objects.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

constexpr int width = 128, height = 72;
constexpr int most_reference_depth = 16;

// The diffuse light that `path` finds at what the pixels' centres see, where maps may know it.
struct DiffuseView {
  std::vector<Hit> hit;
  std::vector<Ray> ray;
  std::vector<float> light, variance;  // luminance; of its mean
};

DiffuseView find_diffuse(const World& world, const Lights& lights, const View& view, int spp) {
  const Transport transport{world, *lights.tables};
  const size_t pixels = size_t(view.width) * size_t(view.height);
  DiffuseView seen{std::vector<Hit>(pixels), std::vector<Ray>(pixels), std::vector<float>(pixels),
                   std::vector<float>(pixels)};
  WalkRules rules;
  rules.max_depth = most_reference_depth;
  parallel_for(int(pixels), [&](int i) {
    const Ray ray = view_ray(view, float(i % view.width) + 0.5f, float(i / view.width) + 0.5f);
    const Hit hit = world.intersect(ray);
    seen.ray[size_t(i)] = ray, seen.hit[size_t(i)] = hit;
    if (!hit.valid()) return;
    double sum = 0, squares = 0;
    for (int k = 0; k < spp; k++) {
      Sampler sampler(mix64(uint64_t(i)), uint32_t(k));
      Surface surface = eval_surface(world, ray, hit);
      Bsdf bsdf =
          make_bsdf_in(transport, Media{}, surface, world.material_of(hit.instance), ray.direction);
      bsdf.diffuse = vec3(1);
      const float passes = bsdf.coat_passes * bsdf.beneath;
      sampler.seek(Dimensions::first_surface);
      DirectLight direct = sample_direct_light(transport, Walk{}, surface, bsdf, true, sampler);
      vec3 light = direct.area_diffuse + direct.punctual_diffuse;
      sampler.seek(Dimensions::first_surface + Dimensions::scatter);
      Walk walk;
      if (advance(walk, surface, sample_bsdf(bsdf, Lobes::diffuse, sampler))) {
        walk.from_normal = surface.geometric_normal;
        walk.area_share = transport.tables.area_share > 0 ? 1.0f : 0.0f;
        sampler.seek(Dimensions::walk);
        light += follow(transport, rules, walk, sampler);
      }
      double l = double(luminance(light)) / double(std::max(passes, 0.05f));
      sum += l, squares += l * l;
    }
    const double mean = sum / spp;
    seen.light[size_t(i)] = float(mean);
    seen.variance[size_t(i)] = float(std::max(squares / spp - mean * mean, 0.0) / spp);
  });
  return seen;
}

// Returns the light that a picture takes from the map, with normal maps.
vec3 light_of(const World& world, const Lights& lights, const IlluminationMap& map, const Ray& ray,
              const Hit& hit) {
  Transport transport{world, *lights.tables};
  transport.maps = &map;
  return find_known_light(transport, ray, hit, eval_surface(world, ray, hit)).light;
}

struct MapError {
  double error = 0, bias = 0, noise = 0, known = 0;
};
// Root mean square over the mean light, of all pixels that the map knows, without the reference's
// own noise.
MapError judge(const World& world, const Lights& lights, const IlluminationMap& map,
               const std::vector<DiffuseView>& views) {
  double squares = 0, sum = 0, bias = 0, noise = 0, count = 0, all = 0;
  for (const DiffuseView& view : views)
    for (size_t i = 0; i < view.hit.size(); i++, all++) {
      const Hit& hit = view.hit[i];
      if (!hit.valid()) continue;
      bool front = dot(eval_face(world, hit.instance, hit.triangle), view.ray[i].direction) < 0;
      uint32_t chart = map.places->find(hit.instance, hit.triangle, front);
      if (chart == no_chart) continue;
      double off =
          double(luminance(light_of(world, lights, map, view.ray[i], hit))) - double(view.light[i]);
      squares += off * off, bias += off, sum += double(view.light[i]);
      noise += double(view.variance[i]), count++;
    }
  const double mean = sum / count;
  return {std::sqrt(std::max(squares - noise, 0.0) / count) / mean, bias / sum,
          std::sqrt(noise / count) / mean, count / all};
}

// The mean jump of light across edges that charts share on smooth surfaces, over the mean light.
double seam_error(const Bake& bake, const IlluminationMap& map) {
  double sum = 0, count = 0;
  for (const ChartSeam& seam : bake.charts.seams) {
    vec3 place = 0.5f * (seam.from + seam.to), light[2];
    for (int side = 0; side < 2; side++)
      light[side] = eval_illumination(map, map.places->charts[seam.chart[side]], place);
    sum += double(luminance(abs(light[0] - light[1]))), count++;
  }
  return count > 0 && map.mean > 0 ? sum / count / double(map.mean) : 0;
}

struct Bakery {
  std::string scene;
  const World& world;
  const Lights& lights;
  std::vector<vec3> places, eyes;
  std::vector<DiffuseView> views;
};

void add(BenchReport& report, const Bakery& bakery, const char* technique, double seconds,
         const IlluminationMap& map) {
  nlohmann::json fields = {{"scene", bakery.scene}, {"technique", technique}, {"seconds", seconds}};
  MapError error = judge(bakery.world, bakery.lights, map, bakery.views);
  report.add("bake.rmse", error.error, "share", fields);
  report.add("bake.rmse_true", error.error, "share", fields);
  report.add("bake.bias", error.bias, "share", fields);
  report.add("bake.reference_noise", error.noise, "share", fields);
  report.add("bake.known", error.known, "share", fields);
  report.add("bake.rmse_told", double(map.error), "share", fields);
}

void bake_by_samples(BenchReport& report, const Bakery& bakery, bool gathers,
                     const std::vector<double>& marks) {
  const double began = seconds_now();
  const BakeScene scene = gathers ? make_bake_scene(bakery.world, bakery.places)
                                  : make_bake_scene_of_paths(bakery.world);
  Bake bake = begin_bake(bakery.world, bakery.places);
  for (double mark : marks) {
    go_on(scene, bake, [&] { return seconds_now() - began >= mark && bake.passes > 0; });
    auto map = finish_map(bakery.world, bakery.eyes, bake);
    add(report, bakery, gathers ? "gather" : "paths", mark, *map);
    if (mark != marks.back() || !gathers) continue;
    nlohmann::json fields = {{"scene", bakery.scene}};
    report.add("bake.texels", double(map->nodes.light.size()), "texels", fields);
    report.add("bake.bytes", double(memory_bytes(*map)), "B", fields);
    report.add("bake.vertex_bytes", double(vertex_bytes(bake)), "B", fields);
    report.add("bake.seam", seam_error(bake, *map), "share", fields);
  }
}

void bake_by_particles(BenchReport& report, const Bakery& bakery,
                       const std::vector<double>& marks) {
  const double began = seconds_now();
  const BakeScene scene = make_bake_scene_of_paths(bakery.world);
  BakeSettings settings;
  Bake bake = begin_bake(bakery.world, {}, settings);
  BakeField sums = bake.gather;
  uint64_t count = 0;
  for (double mark : marks) {
    for (constexpr uint64_t some = 1 << 18; seconds_now() - began < mark; count += some)
      trace_particles(scene, bake, count, some, sums);
    Bake finished = bake;
    finished.direct = sums;
    finish_particles(bakery.world, bake, count, finished.direct);
    std::fill(finished.gather.count.begin(), finished.gather.count.end(), 1.0f);
    finished.passes = 1;
    add(report, bakery, "particles", mark, *finish_map(bakery.world, bakery.eyes, finished));
  }
}

}  // namespace

void bench_bake(BenchReport& report, const BenchOptions& options) {
  std::vector<double> marks = {30, 120, 600};
  int spp = 1024;
  if (options.quick) marks = {5, 15}, spp = 128;
  if (options.bake_seconds > 0) marks = {options.bake_seconds / 4, options.bake_seconds};
  {
    BenchScene hall = load_bench_scene(options, "diffuse_hall");
    World world(hall.scene);
    Lights lights = make_lights(world);
    Bakery bakery{hall.name, world, lights, {vec3(hall.camera.position - hall.scene.origin)},
                  {},        {}};
    bakery.eyes = bakery.places;
    bakery.views.push_back(find_diffuse(world, lights, bench_view(hall, width, height), spp));
    bake_by_samples(report, bakery, true, marks);
    bake_by_samples(report, bakery, false, marks);
    bake_by_particles(report, bakery, marks);
  }
  Exhibit castle = load_exhibit(options.content + "/castle");
  World world(castle.scene);
  Lights lights = make_lights(world);
  Bakery bakery{"castle", world, lights, eye_places(castle), all_eye_places(castle), {}};
  for (const char* name : {"hall", "figure", "fireplace"}) {
    const Viewpoint& at = castle.viewpoints[size_t(find_viewpoint(castle, name))].view;
    View view = make_view(castle.scene, at.position, at.yaw, at.pitch, at.fov, width, height);
    bakery.views.push_back(find_diffuse(world, lights, view, spp));
  }
  bake_by_samples(report, bakery, true, marks);
}

}  // namespace wellspring::test
