// SPDX-License-Identifier: Apache-2.0
// cache.rest.flip: a visitor jumps to a place and stands still. FLIP and RMSE (of display values)
// of what is shown after half a second to 20 s, against the converged `path` of that view. Samples
// are those that a renderer of so many samples a second has for each pixel of 1280x720; pictures
// are smaller, with as many samples a pixel, so that the machine's speed is stated and not in the
// result. Beside them: cache.rest.truth_halves_flip, what of that the converged pictures' own noise
// may be, and cache.rest.technique_flip, what the samples of the first two seconds would show if
// there were plenty.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/rng.h"
#include "cache_visit_judge.h"
#include "cache_visit_method.h"
#include "cache_visit_truth.h"
#include "frame/picture_file.h"
#include "judge/flip.h"
#include "light_scenes.h"
#include "report.h"
#include "show/draw/decide.h"
#include "show/exhibit/load/exhibit_load.h"

namespace wellspring::test {
namespace {

constexpr double clock_rate = 60;  // the simulated clock's pictures
constexpr double full_width = 1280, full_pixels = 1280.0 * 720.0;
constexpr double judged_at[] = {0.5, 1, 2, 5, 20};
constexpr float moving_clamp = 4, still_clamp = 12;  // as ShowSettings

// Holds a place where visitors stand. `part`: not the whole picture but so many pixels of one that
// is 1280 wide, around (right, up) of its centre in halves of its height: edges and textures are as
// wide as visitors see them.
struct Place {
  const char *name, *scene, *viewpoint;
  bool part = false;
  float right = 0, up = 0;
};
constexpr Place places[] = {
    {"cornell_box", "cornell_box", ""},
    {"castle", "castle", "hall"},
    {"castle_part", "castle", "hall", true, -0.55f, 0.1f},
    {"castle_crown", "castle", "crown"},
    {"diffuse_hall", "diffuse_hall", ""},
};

struct Stand {
  std::string name;
  const World& world;
  const Lights& lights;
  View view;
  const Truth& truth;
  int max_depth;
};

View part_of(const View& whole, const Place& place, int width, int height) {
  View part = whole;
  vec3 towards =
      whole.forward + whole.tan_half_fov * (place.right * whole.right + place.up * whole.up);
  part.forward = normalize(towards);
  part.right = normalize(cross(part.forward, whole.up));
  part.up = cross(part.right, part.forward);
  part.tan_half_fov = whole.tan_half_fov * float(double(width) / full_width);
  part.width = width, part.height = height;
  return part;
}

void judge(BenchReport& report, const std::string& name, const Frame& shown, const Truth& truth,
           const nlohmann::json& fields) {
  Image8 pictures[3];
  tonemap(shown, {}, pictures[0]), tonemap(truth.half[0], {}, pictures[1]),
      tonemap(truth.half[1], {}, pictures[2]);
  report.add("cache.rest." + name + "flip", flip(shown, truth.picture), "FLIP", fields);
  report.add("cache.rest." + name + "rmse", display_rmse(pictures[0], pictures[1], pictures[2]),
             "of white", fields);
}

// The picture and where it errs: FLIP of 0.25 and more is white.
void save_judged(const BenchOptions& options, const std::string& name, const Frame& shown,
                 const Truth& truth) {
  if (options.visit_pictures.empty()) return;
  std::string file = options.visit_pictures + "/rest_" + name;
  save_picture(file + ".png", shown, {});
  FlipMap map = eval_flip(shown, truth.picture);
  Frame error = shown;
  for (size_t i = 0; i < map.error.size(); i++)
    error.color[i] = vec3(std::pow(std::min(4 * map.error[i], 1.0f), 2.2f));
  save_picture(file + "_error.png", error, {});
}

void stand(BenchReport& report, const BenchOptions& options, const Stand& at,
           const std::string& name, double samples_a_second) {
  std::unique_ptr<VisitMethod> method =
      name == "denoised" ? make_drawn({.denoises = true}) : make_visit_method(name);
  double pixels = double(at.view.width) * double(at.view.height), owed = 0, spent = 0;
  VisitPicture shown;
  VisitMoment moment;
  moment.world = &at.world;
  moment.lights = &at.lights;
  moment.view = at.view;
  moment.transport.max_depth = at.max_depth;
  int frame = 0;
  bool settled = false;
  for (double seconds : judged_at) {
    if (options.quick && seconds > 2) break;
    for (; frame < int(std::lround(seconds * clock_rate)); frame++) {
      settled = wants_reference(frame / clock_rate, settled,
                                float(shown.stats.filled + shown.empty), shown.stats.converged);
      moment.technique = find_technique(settled ? "path" : "gather");
      moment.transport.clamp = settled ? still_clamp : moving_clamp;
      moment.frame = frame;
      moment.changed = frame == 0;
      moment.seed = mix64(uint64_t(frame + 1) * 0x9e3779b9u);
      owed += samples_a_second / clock_rate * pixels / full_pixels;
      int budget = int(owed);
      owed -= budget;
      spent += budget;
      method->show(moment, budget, shown);
    }
    judge(report, "", shown.frame, at.truth,
          {{"scene", at.name},
           {"method", name},
           {"seconds", seconds},
           {"samples_a_second", samples_a_second},
           {"samples_a_pixel", spent / pixels},
           {"settled", settled}});
    save_judged(options,
                at.name + "_" + name + "_" + std::to_string(int(samples_a_second / 1000)) + "k_" +
                    std::to_string(int(seconds * 10)),
                shown.frame, at.truth);
  }
}

// Judges what `gather` would show if there were plenty of samples, with and without their bound.
void judge_technique(BenchReport& report, const BenchOptions& options, const Stand& at) {
  for (float clamp : {0.0f, moving_clamp}) {
    StillSettings still;
    still.spp = options.quick ? 64 : 256;
    still.transport.max_depth = at.max_depth;
    still.transport.clamp = clamp;
    Frame frame = render_still(*find_technique("gather"), at.world, at.lights, at.view, still);
    judge(report, "technique_", frame, at.truth,
          {{"scene", at.name}, {"clamp", clamp}, {"spp", still.spp}});
    save_judged(options, at.name + "_gather" + (clamp > 0 ? "_clamped" : ""), frame, at.truth);
  }
}

bool is_wanted(const BenchOptions& options, const std::string& name) {
  const auto& wanted = options.visit_methods;
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

void bench_place(BenchReport& report, const BenchOptions& options, const Place& place,
                 TruthSettings truths) {
  BenchScene scene = load_bench_scene(options, place.scene);
  if (*place.viewpoint)
    for (const auto& one :
         load_exhibit((std::filesystem::path(options.content) / place.scene).string()).viewpoints)
      if (one.view.name == place.viewpoint) scene.camera = one.view;
  World world(scene.scene);
  world.commit();
  Lights lights = make_lights(world);
  int width = options.visit_width > 0 ? options.visit_width : 192, height = (width * 9 + 8) / 16;
  View view = bench_view(scene, width, height);
  if (place.part) view = part_of(view, place, width, height);
  find_technique("gather")->prepare(world, std::span(&view.position, 1), lights);
  truths.max_depth = scene.max_depth;
  Truth truth = find_truth(world, lights, view, truths);
  report.add("cache.rest.truth_halves_flip", flip(truth.half[0], truth.half[1]), "FLIP",
             {{"scene", place.name}, {"spp", truths.spp}});
  save_judged(options, std::string(place.name) + "_truth", truth.picture, truth);
  Stand at{place.name, world, lights, view, truth, scene.max_depth};
  if (is_wanted(options, "technique")) judge_technique(report, options, at);
  for (const char* method : {"cache", "primary", "denoised"})
    if (is_wanted(options, method))
      for (double speed : {0.5e6, 2e6, 8e6}) stand(report, options, at, method, speed);
}

}  // namespace

void bench_cache_rest(BenchReport& report, const BenchOptions& options) {
  if (!options.visit_pictures.empty()) std::filesystem::create_directories(options.visit_pictures);
  TruthSettings truths;
  truths.spp = options.visit_spp > 0 ? options.visit_spp : options.quick ? 64 : 256;
  truths.folder = truths_folder(options);
  for (const Place& place : places)
    if (options.visit_trace.empty() || options.visit_trace == place.name)
      bench_place(report, options, place, truths);
}

}  // namespace wellspring::test
