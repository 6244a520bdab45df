// SPDX-License-Identifier: Apache-2.0
// cache.starve.flip: what a visitor sees of a place never seen before while only a few samples a
// hundred pixels are there, as on a busy machine: FLIP against the converged `path` of that view.
// Samples of `gather`, each picture the four hundredth part of a sample a pixel, so that the
// machine's speed is not in the result. Once more where a lamp without a size lights the box.
#include <cmath>
#include <filesystem>

#include "base/rng.h"
#include "cache_visit_method.h"
#include "cache_visit_truth.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "light_scenes.h"
#include "report.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr int pixels_a_sample = 400;
constexpr int starved_judged_after[] = {5, 14, 40, 100, 300};  // pictures

struct StarvedPlace {
  std::string scene, name;
  Viewpoint camera;
};

void starve(BenchReport& report, const BenchOptions& options, const VisitMoment& begun,
            const Truth& truth, const StarvedPlace& place, const char* name) {
  std::unique_ptr<VisitMethod> method = make_visit_method(name);
  VisitMoment moment = begun;
  VisitPicture shown;
  int pixels = moment.view.width * moment.view.height, budget = pixels / pixels_a_sample;
  for (int pictures : starved_judged_after) {
    if (options.quick && pictures > 100) break;
    for (; moment.frame < pictures; moment.frame++) {
      moment.changed = moment.frame == 0;
      moment.seed = mix64(uint64_t(moment.frame + 1) * 0x9e3779b9u);
      method->show(moment, budget, shown);
    }
    report.add("cache.starve.flip", flip(shown.frame, truth.picture), "FLIP",
               {{"scene", place.scene},
                {"view", place.name},
                {"method", name},
                {"samples_a_pixel", double(budget) * pictures / pixels}});
    if (options.visit_pictures.empty()) continue;
    save_picture(options.visit_pictures + "/starve_" + place.name + "_" + name + "_" +
                     std::to_string(pictures) + ".png",
                 shown.frame, {});
  }
}

// Lit without chance but for what walls send on.
void light_by_point(Scene& box) {
  for (Material& material : box.materials) material.emission = vec3(0);
  PunctualLight lamp;
  lamp.position = {0, 0.54f, -0.28f};
  lamp.intensity = {0.25f, 0.2f, 0.12f};
  box.lights.push_back(lamp);
}

std::vector<StarvedPlace> places_of(const BenchOptions& options, const std::string& name,
                                    const Viewpoint& camera) {
  if (name != "castle") return {{name, name, camera}};
  std::vector<StarvedPlace> places;
  Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
  for (const ExhibitViewpoint& one : castle.viewpoints)
    places.push_back({name, one.view.name, one.view});
  if (options.quick) places.resize(3);
  return places;
}

}  // namespace

void bench_cache_starve(BenchReport& report, const BenchOptions& options) {
  if (!options.visit_pictures.empty()) std::filesystem::create_directories(options.visit_pictures);
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 48 : 192;
  truths.folder = truths_folder(options);
  int width = options.visit_width > 0 ? options.visit_width : 320, height = (width * 9 + 8) / 16;
  const std::pair<const char*, bool> scenes[] = {
      {"castle", false}, {"cornell_box", false}, {"cornell_box", true}, {"conference", false}};
  for (auto [from, one_point] : scenes) {
    BenchScene scene = load_bench_scene(options, from);
    if (one_point) light_by_point(scene.scene);
    std::vector<StarvedPlace> places =
        places_of(options, from + std::string(one_point ? "_point" : ""), scene.camera);
    World world(scene.scene);
    world.commit();
    Lights lights = make_lights(world);
    VisitMoment moment;
    moment.world = &world;
    moment.lights = &lights;
    moment.technique = find_technique("gather");
    moment.transport.max_depth = truths.max_depth = scene.max_depth;
    moment.transport.clamp = 4;  // as ShowSettings::moving_clamp
    std::vector<vec3> eyes;
    for (const StarvedPlace& place : places) {
      scene.camera = place.camera;
      eyes.push_back(bench_view(scene, width, height).position);
    }
    find_technique("gather")->prepare(world, eyes, lights);
    for (const StarvedPlace& place : places) {
      scene.camera = place.camera;
      moment.view = bench_view(scene, width, height);
      Truth truth = find_truth(world, lights, moment.view, truths);
      for (const char* method : {"cache", "primary"})
        starve(report, options, moment, truth, place, method);
    }
  }
}

}  // namespace wellspring::test
