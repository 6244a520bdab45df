// SPDX-License-Identifier: Apache-2.0
// How far a bounce by multiresolution splatting is from that of `path`, what a choice of VPLs
// does, and what is seen of it while a light moves.
#include <cmath>

#include "judge/flip.h"
#include "light/sample/light_tables.h"
#include "light_reference.h"
#include "light_scenes.h"
#include "splat_bench.h"

namespace wellspring::test {
namespace {

constexpr int one_bounce = 3;  // edges of a path

Frame render(const char* technique, const World& world, const Lights& lights, const View& view,
             const SplatSettings& splat, int spp, uint64_t seed) {
  StillSettings settings;
  settings.spp = spp;
  settings.seed = seed;
  settings.transport.max_depth = one_bounce;
  settings.transport.splat = splat;
  return render_still(*find_technique(technique), world, lights, view, settings);
}

// Direct light, and what so many passes add to it: samples of both techniques are the same.
Frame with_bounce(const Frame& direct, const World& world, const Lights& lights, const View& view,
                  const SplatSettings& splat, int passes) {
  Frame with = render("multires_splatting", world, lights, view, splat, passes, 5);
  Frame without = render("direct", world, lights, view, splat, passes, 5);
  Frame frame = direct;
  for (size_t i = 0; i < frame.color.size(); i++)
    frame.color[i] += with.color[i] - without.color[i];
  return frame;
}

struct Tried {
  const char* scene;
  int virtual_lights;
};

void bench_scene(BenchReport& report, const BenchOptions& options, const Tried& tried) {
  const char* name = tried.scene;
  BenchScene bench = load_bench_scene(options, name);
  World world(bench.scene);
  Lights lights = make_lights(world);
  View view = bench_view(bench, 192, 108);
  TransportSettings transport;
  transport.max_depth = one_bounce;
  Reference reference = make_reference(world, lights, view, transport, options.quick ? 15 : 60);
  const Frame& truth = reference.frame;
  Frame direct = render("direct", world, lights, view, {}, 64, 9);
  SplatSettings with;
  with.virtual_lights = tried.virtual_lights;
  with.texels = 16 * tried.virtual_lights;
  SplatSettings without = with, naive;
  without.visibility = naive.visibility = false;
  naive.coarsest = 1 << 15;
  naive.virtual_lights = 2048;
  naive.texels = 1 << 15;
  Frame open = with_bounce(direct, world, lights, view, naive, 16);
  for (int passes : {1, 16}) {
    nlohmann::json fields = {{"scene", name},
                             {"passes", passes},
                             {"lights", tried.virtual_lights},
                             {"reference_flip", reference.flip}};
    Frame shadowed = with_bounce(direct, world, lights, view, with, passes),
          plain = with_bounce(direct, world, lights, view, without, passes);
    report.add("splat.flip", flip(shadowed, truth), "1", fields);
    report.add("splat.flip_without", flip(plain, open), "1", fields);
    report.add("splat.flip_left_out", flip(plain, truth), "1", fields);
    report.add("splat.flip_direct", flip(direct, truth), "1", fields);
  }
}

using Picture = std::vector<vec3>;

// Mean second difference from picture to picture over the mean.
double flicker_of(const std::vector<Picture>& pictures) {
  double differs = 0, sum = 0;
  for (size_t t = 1; t + 1 < pictures.size(); t++)
    for (size_t i = 0; i < pictures[t].size(); i++) {
      differs +=
          std::abs(double(luminance(pictures[t - 1][i])) - 2 * double(luminance(pictures[t][i])) +
                   double(luminance(pictures[t + 1][i])));
      sum += double(luminance(pictures[t][i]));
    }
  return sum > 0 ? differs / sum : 0;
}

void bench_choice(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "castle");
  World world(bench.scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  SeenPixels seen(world, lights, bench_view(bench, 192, 108));
  std::vector<LitProbe> probes;
  find_splat_probes(seen.pixels(), 64, probes);
  auto splat = [&](const SplatSettings& settings, int step, SplatSeed seed) {
    SplatLights drawn;
    SplatPicture picture;
    SplatSource torch = carried_torch(seen.view, step);
    draw_virtual_lights(transport, std::span(&torch, 1), settings, seed, probes, drawn);
    splat_picture(transport, drawn, seen.pixels(), settings, seed, picture);
    return Picture(picture.irradiance.begin(), picture.irradiance.end());
  };
  Picture mean;
  SplatSettings exact;
  exact.virtual_lights = 4096, exact.texels = 1 << 16, exact.visibility = false;
  constexpr int passes = 8;
  for (uint32_t pass = 0; pass < passes; pass++) {
    Picture one = splat(exact, 0, {77, pass});
    mean.resize(one.size(), vec3(0));
    for (size_t i = 0; i < one.size(); i++) mean[i] += one[i] / float(passes);
  }
  SplatSettings settings;
  settings.visibility = false;
  double squares = 0, own = 0;
  for (uint64_t seed = 0; seed < 8; seed++) {
    Picture one = splat(settings, 0, {seed, 0});
    for (size_t i = 0; i < one.size(); i++) {
      dvec3 differs = dvec3(one[i]) - dvec3(mean[i]);
      squares += dot(differs, differs), own += dot(dvec3(mean[i]), dvec3(mean[i]));
    }
  }
  std::vector<Picture> walk;
  for (int step = 0; step < 12; step++) walk.push_back(splat(settings, step, {}));
  report.add("splat.choice_rms", std::sqrt(squares / own), "1", {{"scene", "castle"}});
  report.add("splat.choice_flicker", flicker_of(walk), "1", {{"scene", "castle"}});
}

// The Cornell box by a bulb that moves by a centimetre a picture, the same random numbers in each
// picture. A pass of instant_radiosity takes its time; splatting has the virtual lights and shadow
// rays that it can have in about that time.
void bench_flicker(BenchReport& report, const BenchOptions& options) {
  const BenchScene bench = load_bench_scene(options, "cornell_box");
  const char* names[] = {"direct", "multires_splatting", "instant_radiosity"};
  SplatSettings settings;
  settings.virtual_lights = 1024;
  settings.texels = 16384;
  settings.probe_rays = 0;  // which let subsplats come and go
  settings.shadow_rays = 40;
  settings.smooth_visibility = 3;
  for (const char* name : names) {
    std::vector<Picture> walk;
    std::vector<double> seconds;
    for (int step = 0; step < 12; step++) {
      Scene scene = bench.scene;
      for (Material& m : scene.materials) m.emission = vec3(0);
      PunctualLight bulb;
      bulb.position = vec3(dvec3(0.01 * double(step) - 0.05, 0.4, -0.2) - scene.origin);
      scene.lights.push_back(bulb);
      World world(scene);
      Lights lights = make_lights(world);
      View view = bench_view(bench, 256, 256);
      double began = processor_seconds();
      Frame frame = render(name, world, lights, view, settings, 1, 3);
      seconds.push_back(processor_seconds() - began);
      walk.emplace_back(frame.color.begin(), frame.color.end());
    }
    report.add("splat.flicker", flicker_of(walk), "1",
               {{"technique", name}, {"processor_ms", 1000 * quantile(seconds, 0.5)}});
  }
}

}  // namespace

void bench_splat_error(BenchReport& report, const BenchOptions& options) {
  const Tried all[] = {
      {"cornell_box", 256}, {"diffuse_hall", 256}, {"castle", 256}, {"castle", 1024}};
  for (const Tried& tried : all) bench_scene(report, options, tried);
  bench_choice(report, options);
  bench_flicker(report, options);
}

}  // namespace wellspring::test
