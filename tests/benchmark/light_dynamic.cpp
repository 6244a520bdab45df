// SPDX-License-Identifier: Apache-2.0
#include "light_dynamic.h"

#include <cmath>
#include <functional>

#include "base/clock.h"
#include "judge/flip.h"
#include "light/virtual/dynamic_image.h"
#include "light/technique/technique.h"
#include "light_scenes.h"
#include "picture/compositor.h"
#include "tests/scenes/dynamic_picture.h"

namespace wellspring::test {
namespace {

constexpr int width = 1280, height = 720;
constexpr int judged_width = 320, judged_height = 180;
constexpr float exposure = 1.5f;

DynamicLight torch_at(double place) {
  DynamicLight torch;
  torch.light.intensity = vec3(12, 6.6f, 2.4f);
  torch.light.position = {float(1.8 + 1.5 * std::sin(place)), 1.9f, float(1.3 * std::cos(place))};
  return torch;
}

// The scene without light of its own.
Scene make_dark(Scene scene) {
  scene.lights.clear();
  scene.lamps.clear();
  scene.environment = {};
  for (Material& m : scene.materials) m.emission = vec3(0);
  return scene;
}

// Draws a picture of the dynamic light alone.
Frame draw_light(const VisibilityPass& visibility, const DynamicImage& image, const View& view) {
  Frame frame;
  fit_frame(view.width, view.height, frame);
  frame.color = scenes::draw_dynamic_light(visibility, image, view);
  return frame;
}

struct Stages {
  std::vector<double> surfaces, direct, maps, splat, put, whole;
};

// Measures a picture at rest with the torch at a place, in milliseconds of processor time; `clock`:
// in milliseconds of the clock. Each stage is then run again to measure its own time.
void time_picture(const World& world, const Lights& lights, const VisibilityPass& visibility,
                  const Keyframe& keyframe, const BackdropSurfaces& backdrop,
                  const DynamicLight& torch, const SplatSettings& settings, DynamicImage& image,
                  Stages& cpu, std::vector<double>& clock) {
  auto timed = [](std::vector<double>& to, const std::function<void()>& work) {
    const double began = process_seconds_now();
    work();
    to.push_back(1000 * (process_seconds_now() - began));
  };
  Image8 picture;
  std::vector<uint8_t> peaks;
  const DynamicLights lit{torch};
  auto put = [&] { relight(keyframe, {backdrop, image.light}, {exposure}, picture, peaks); };
  const double began = seconds_now();
  timed(cpu.whole, [&] {
    begin_bounce(world, lights, lit, backdrop.surfaces, settings, {}, image.bounce);
    light_surfaces(world, lights, lit, backdrop.surfaces, settings, image.bounce, image.light);
    put();
  });
  clock.push_back(1000 * (seconds_now() - began));
  timed(cpu.put, put);
  timed(cpu.surfaces,
        [&] { see_surfaces(visibility, dynamic_light_view(keyframe.view), image.surfaces); });
  timed(cpu.maps,
        [&] { begin_bounce(world, lights, lit, backdrop.surfaces, settings, {}, image.bounce); });
  timed(cpu.direct, [&] {
    clear_planes(backdrop.surfaces, image.light);
    add_direct_light(world, lights, lit, backdrop.surfaces, image.light);
  });
  timed(cpu.splat, [&] {
    light_surfaces(world, lights, lit, backdrop.surfaces, settings, image.bounce, image.light);
  });
  cpu.splat.back() = std::max(cpu.splat.back() - cpu.direct.back(), 0.0);
}

// One bounce of `path` with the light as a lamp of the scene.
Frame find_truth(const Scene& dark, const View& view, const DynamicLight& torch, int spp) {
  Scene lit = dark;
  lit.lights.push_back(torch.light);
  World world(lit);
  Lights lights = make_lights(world);
  StillSettings still;
  still.spp = spp;
  still.transport.max_depth = 3;
  return render_still(*find_technique("path"), world, lights, view, still);
}

// Mean over pixels of how much the light's second difference over time is of it: 0 where light
// changes evenly as the torch moves evenly.
double find_flicker(const World& world, const Lights& lights, const VisibilityPass& visibility,
                    const View& view, const SplatSettings& settings, int pictures) {
  std::vector<std::vector<float>> seen;
  for (int i = 0; i < pictures; i++) {
    DynamicImage image;
    compute_dynamic_light(world, lights, visibility, view, DynamicLights{torch_at(0.02 * i)},
                          settings, image);
    std::vector<float> light;
    for (vec3 one : image.bounce.picture.irradiance) light.push_back(luminance(one));
    seen.push_back(std::move(light));
  }
  double sum = 0, level = 0;
  for (size_t k = 2; k < seen.size(); k++)
    for (size_t i = 0; i < seen[k].size(); i++) {
      sum += double(std::abs(seen[k][i] - 2 * seen[k - 1][i] + seen[k - 2][i]));
      level += double(seen[k][i]);
    }
  return level > 0 ? sum / level : 0;
}

// A light that stays as it is: the light of its bounce, pass by pass.
void bench_settled(BenchReport& report, const char* name, const DynamicLight& light,
                   const World& world, const Lights& lights, const VisibilityPass& visibility,
                   const BackdropSurfaces& large, const View& judged, const Frame& truth) {
  const SplatSettings settings = dynamic_splat_settings();
  DynamicImage image;
  see_surfaces(visibility, dynamic_light_view(judged), image.surfaces);
  SettledBounce settled, timed;
  settled.lights = timed.lights = {light};
  std::vector<double> cpu;
  for (int pass = 1; pass <= most_passes; pass++) {
    add_pass(world, lights, image.surfaces, settings, settled, image.bounce);
    const double began = process_seconds_now();
    add_pass(world, lights, large.surfaces, settings, timed, image.bounce);
    if (pass > 1) cpu.push_back(1000 * (process_seconds_now() - began));
    if ((pass & (pass - 1)) != 0) continue;
    clear_planes(image.surfaces, image.light);
    add_direct_light(world, lights, settled.lights, image.surfaces, image.light);
    add_settled(settled, image.light);
    report.add(
        "light.dynamic.settled_flip",
        flip(draw_light(visibility, image, judged), truth, {exposure}), "",
        {{"light", name}, {"passes", pass}, {"pass_ms", cpu.empty() ? 0 : quantile(cpu, 0.5)}});
  }
}

}  // namespace

void bench_light_dynamic(BenchReport& report, const BenchOptions& options) {
  BenchScene castle = load_bench_scene(options, "castle");
  const Scene dark = make_dark(castle.scene);
  World world(dark);
  Lights lights = make_lights(world);
  VisibilityPass visibility(world, lights);
  const View view = bench_view(castle, width, height);
  const View judged = bench_view(castle, judged_width, judged_height);
  Keyframe keyframe;
  Image8 black;
  black.width = width, black.height = height;
  black.rgb.assign(size_t(3) * width * height, 20);
  make_keyframe(view, black, std::vector<float>(size_t(width) * height, 3.0f), keyframe);
  const int places = options.quick ? 4 : 8, spp = options.quick ? 256 : 2048;
  std::vector<Frame> truths;
  for (int i = 0; i < 2; i++) truths.push_back(find_truth(dark, judged, torch_at(i), spp));
  BackdropSurfaces backdrop;
  find_backdrop_surfaces(visibility, view, backdrop);
  for (bool visible : {true, false})
    for (int count : {0, 64, 128, 256, 512, 1024}) {
      if (count == 0 && !visible) continue;
      SplatSettings settings = dynamic_splat_settings();
      settings.virtual_lights = count;
      settings.visibility = visible;
      Stages cpu;
      std::vector<double> clock;
      DynamicImage image;
      for (int i = 0; i <= places; i++) {
        if (i == 1) cpu = {}, clock.clear();  // arrays are there now
        time_picture(world, lights, visibility, keyframe, backdrop, torch_at(i), settings, image,
                     cpu, clock);
      }
      nlohmann::json fields = {{"virtual_lights", count},
                               {"shadows", visible ? "yes" : "no"},
                               {"surfaces_ms", quantile(cpu.surfaces, 0.5)},
                               {"direct_ms", quantile(cpu.direct, 0.5)},
                               {"maps_ms", quantile(cpu.maps, 0.5)},
                               {"splat_ms", quantile(cpu.splat, 0.5)},
                               {"put_ms", quantile(cpu.put, 0.5)},
                               {"clock_ms", quantile(clock, 0.5)},
                               {"subsplats", image.bounce.picture.counters.all_subsplats()},
                               {"width", width},
                               {"height", height}};
      double error = 0;
      for (size_t i = 0; i < truths.size(); i++) {
        DynamicImage seen;
        compute_dynamic_light(world, lights, visibility, judged, DynamicLights{torch_at(double(i))},
                              settings, seen);
        error += flip(draw_light(visibility, seen, judged), truths[i], {exposure}) /
                 double(truths.size());
      }
      fields["flip"] = error;
      fields["flicker"] =
          find_flicker(world, lights, visibility, judged, settings, options.quick ? 8 : 24);
      report.add("light.dynamic.picture_ms", quantile(cpu.whole, 0.5), "ms", fields);
    }
  bench_settled(report, "torch", torch_at(0), world, lights, visibility, backdrop, judged,
                truths[0]);
  DynamicLight sun;
  for (const PunctualLight& one : castle.scene.lights)
    if (one.type == PunctualType::directional) sun.light = one;
  bench_settled(report, "sun", sun, world, lights, visibility, backdrop, judged,
                find_truth(dark, judged, sun, spp));
}

}  // namespace wellspring::test
