// SPDX-License-Identifier: Apache-2.0
// cache.rest.flip: a visitor jumps to a place and stands still. FLIP of what is shown after half a
// second to 20 s, against the converged `path` of that view. Samples are those that a renderer of so
// many samples a second has for each pixel of 1280x720; pictures are smaller, with as many samples a
// pixel, so that the machine's speed is stated and not in the result.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/rng.h"
#include "cache_visit_method.h"
#include "cache_visit_truth.h"
#include "frame/flip.h"
#include "frame/picture_file.h"
#include "light_scenes.h"
#include "report.h"

namespace wellspring {
namespace {

constexpr double rate = 60, settled_after = 2;  // as show/picture.cpp; the simulated clock's pictures
constexpr double full_pixels = 1280.0 * 720.0;
constexpr double judged_at[] = {0.5, 1, 2, 5, 20};

struct Stand {
  const BenchScene& scene;
  const World& world;
  const Lights& lights;
  View view;
  const Truth& truth;
};

void stand(BenchReport& report, const BenchOptions& options, const Stand& at, const char* name,
           double samples_a_second) {
  std::unique_ptr<VisitMethod> method;
  for (const VisitMethodEntry& entry : visit_methods())
    if (entry.name == std::string(name)) method = entry.make();
  double pixels = double(at.view.width) * double(at.view.height), owed = 0, spent = 0;
  VisitPicture shown;
  VisitMoment moment;
  moment.world = &at.world;
  moment.lights = &at.lights;
  moment.view = at.view;
  int frame = 0;
  for (double seconds : judged_at) {
    if (options.quick && seconds > 2) break;
    for (; frame < int(std::lround(seconds * rate)); frame++) {
      bool settled = frame / rate > settled_after;
      moment.technique = find_technique(settled ? "path" : "gather");
      moment.transport.max_depth = at.scene.max_depth;
      moment.transport.clamp = settled ? 12.0f : 4.0f;  // as ShowSettings
      moment.frame = frame;
      moment.changed = frame == 0;
      moment.seed = mix64(uint64_t(frame + 1) * 0x9e3779b9u);
      owed += samples_a_second / rate * pixels / full_pixels;
      int budget = int(owed);
      owed -= budget;
      spent += budget;
      method->show(moment, budget, shown);
    }
    nlohmann::json fields = {{"scene", at.scene.name},   {"method", name},
                             {"seconds", seconds},       {"samples_a_second", samples_a_second},
                             {"samples_a_pixel", spent / pixels}};
    report.add("cache.rest.flip", flip(shown.frame, at.truth.picture), "FLIP", fields);
    if (options.visit_pictures.empty()) continue;
    std::string file = options.visit_pictures + "/rest_" + at.scene.name + "_" + name + "_" +
                       std::to_string(int(samples_a_second / 1000)) + "k_" +
                       std::to_string(int(seconds * 10)) + ".png";
    save_picture(file, shown.frame, {});
  }
}

}  // namespace

void bench_cache_rest(BenchReport& report, const BenchOptions& options) {
  if (!options.visit_pictures.empty()) std::filesystem::create_directories(options.visit_pictures);
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 64 : 256;
  truths.folder = (std::filesystem::path(options.programs).parent_path() / "visit_truths").string();
  int width = options.visit_width > 0 ? options.visit_width : 256, height = (width * 9 + 8) / 16;
  for (const char* name : {"cornell_box", "castle"}) {
    BenchScene scene = load_bench_scene(options, name);
    World world(scene.scene);
    world.commit();
    Lights lights = make_lights(world);
    View view = bench_view(scene, width, height);
    find_technique("gather")->prepare(world, std::span(&view.position, 1), lights);
    truths.max_depth = scene.max_depth;
    Truth truth = find_truth(world, lights, view, truths);
    report.add("cache.rest.truth_halves_flip", flip(truth.half[0], truth.half[1]), "FLIP",
               {{"scene", name}});
    for (const char* method : {"cache", "primary"})
      for (double speed : {0.5e6, 2e6, 8e6})
        stand(report, options, {scene, world, lights, view, truth}, method, speed);
  }
}

}  // namespace wellspring
