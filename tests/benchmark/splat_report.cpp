// SPDX-License-Identifier: Apache-2.0
// What a picture by multiresolution splatting costs: over virtual lights and resolutions as figure
// 8 of the paper has it, and over the scene's triangles. Processor time of all threads, which other
// work on the machine hardly changes.
#include <ctime>

#include "light/sample/light_tables.h"
#include "light/visible/guides.h"
#include "light_scenes.h"
#include "plot.h"
#include "splat_bench.h"
#include "tessellate.h"

namespace wellspring::test {

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

SeenPixels::SeenPixels(const World& world, const Lights& lights, const View& from) : view(from) {
  std::vector<Ray> rays;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      rays.push_back(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
  std::vector<PrimaryHit> seen(rays.size());
  see(world, lights, rays, seen);
  for (size_t i = 0; i < rays.size(); i++) {
    bool lit = seen[i].scatters && std::isfinite(seen[i].distance);
    depth.push_back(lit ? seen[i].distance * dot(rays[i].direction, view.forward)
                        : std::numeric_limits<float>::infinity());
    nx.push_back(seen[i].normal.x), ny.push_back(seen[i].normal.y), nz.push_back(seen[i].normal.z);
  }
}

SplatPixels SeenPixels::pixels() const {
  SplatPixels pixels;
  pixels.view = view;
  pixels.depth = depth.data();
  pixels.nx = nx.data(), pixels.ny = ny.data(), pixels.nz = nz.data();
  return pixels;
}

SplatSource carried_torch(const View& view, int step) {
  PunctualLight torch;
  torch.position = view.position + view.forward * 3.0f + view.up * 0.3f +
                   view.right * (0.02f * float(step) - 0.3f);
  torch.intensity = {40, 25, 10};
  return make_splat_source(torch, 1);
}

namespace {

// Milliseconds of a picture: the median of a few, once memory is there.
struct Cost {
  double lights_ms = 0, picture_ms = 0;
  SplatCounters counters;
  double all() const { return lights_ms + picture_ms; }
};
Cost measure(const Transport& transport, const SeenPixels& seen, const SplatSource& source,
             const SplatSettings& settings, int turns) {
  SplatLights drawn;
  SplatPicture picture;
  std::vector<double> lights, pictures;
  for (int turn = 0; turn <= turns; turn++) {
    double began = processor_seconds();
    draw_virtual_lights(transport, std::span(&source, 1), settings, {}, {}, drawn);
    double between = processor_seconds();
    splat_picture(transport, drawn, seen.pixels(), settings, {}, picture);
    if (turn == 0) continue;
    lights.push_back(1000 * (between - began));
    pictures.push_back(1000 * (processor_seconds() - between));
  }
  return {quantile(lights, 0.5), quantile(pictures, 0.5), picture.counters};
}

void add_cost(BenchReport& report, const Cost& cost, nlohmann::json fields) {
  fields["lights_ms"] = cost.lights_ms;
  fields["subsplats"] = cost.counters.all_subsplats();
  fields["pixel_subsplats"] = cost.counters.subsplats[0];
  fields["shadow_rays"] = cost.counters.shadow_rays + cost.counters.probe_rays;
  fields["rate_of_four_cores"] = 4000 / cost.all();
  report.add("splat.processor_ms", cost.all(), "ms", fields);
}

void bench_sizes(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "castle");
  World world(bench.scene);
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  Plot plot{"Time of a picture by multiresolution splatting",
            "castle, a carried torch, with shadows",
            "virtual lights",
            "processor time [ms]",
            {},
            0,
            ""};
  for (int side : {128, 256, 512, 1024}) {
    SeenPixels seen(world, lights, bench_view(bench, side, side));
    SplatSource torch = carried_torch(seen.view, 0);
    Curve curve{std::to_string(side) + "x" + std::to_string(side), {}};
    for (int number : {64, 128, 256, 512, 1024}) {
      if (options.quick && number != 256) continue;
      for (bool shadows : {true, false}) {
        SplatSettings settings;
        settings.virtual_lights = number;
        settings.visibility = shadows;
        Cost cost = measure(transport, seen, torch, settings, options.quick ? 3 : 7);
        add_cost(report, cost,
                 {{"scene", "castle"},
                  {"side", side},
                  {"lights", number},
                  {"shadows", shadows ? "yes" : "no"}});
        if (shadows) curve.points.push_back({double(number), cost.all()});
      }
    }
    plot.curves.push_back(curve);
  }
  save_svg(options.plots + "splat_time.svg", plot);
}

void bench_triangles(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "cornell_box");
  double least[2] = {0, 0};
  for (size_t triangles : {size_t(6000), size_t(50000), size_t(400000)}) {
    Scene scene = tessellate(bench.scene, triangles);
    World world(scene);
    Lights lights = make_lights(world);
    SeenPixels seen(world, lights, bench_view(bench, 512, 512));
    PunctualLight bulb;
    bulb.position = vec3(dvec3(0.1, 0.4, -0.2) - scene.origin);
    SplatSource source = make_splat_source(bulb, 1);
    for (bool shadows : {true, false}) {
      SplatSettings settings;
      settings.visibility = shadows;
      Cost cost = measure({world, *lights.tables}, seen, source, settings, options.quick ? 5 : 15);
      if (triangles == 6000) least[shadows] = cost.all();
      report.add("splat.triangles_ms", cost.all(), "ms",
                 {{"triangles", triangle_count(scene)},
                  {"shadows", shadows ? "yes" : "no"},
                  {"subsplats", cost.counters.all_subsplats()}});
      if (triangles == 400000)
        report.add("splat.triangles_ratio", cost.all() / least[shadows], "1",
                   {{"shadows", shadows ? "yes" : "no"}});
    }
  }
}

}  // namespace

void bench_splat(BenchReport& report, const BenchOptions& options) {
  bench_sizes(report, options);
  bench_triangles(report, options);
}

ReportPage splat_page() {
  return {
      "splat",
      "What does a bounce of light by multiresolution splatting cost?",
      {"Milliseconds are processor time of all threads. Four cores: 4000 over that, extrapolated, "
       "as if nothing were lost between them."},
      {{.caption = "A torch in the castle, 256 virtual lights",
        .rows = {{"side", "side"}, {"shadows", "shadows"}},
        .columns = {{"splat.processor_ms", "a picture"},
                    {"splat.processor_ms", "of it maps and lights, ms", 1, "", "lights_ms"},
                    {"splat.processor_ms", "subsplats", 1, "", "subsplats"},
                    {"splat.processor_ms", "shadow rays", 1, "", "shadow_rays"},
                    {"splat.processor_ms", "pictures a second on four cores", 1, "",
                     "rate_of_four_cores"}},
        .only = {{"lights", {256}}},
        .most_rows = 8},
       {.caption = "Over virtual lights, with shadows",
        .rows = {{"side", "side"}},
        .columns = {{"splat.processor_ms", "a picture"}},
        .across = "lights",
        .only = {{"shadows", {"yes"}}},
        .most_rows = 4},
       {.caption = "Over triangles, with shadows or not: the Cornell box, 512x512",
        .rows = {{"triangles", "triangles"}},
        .columns = {{"triangles_ms", "a picture"}},
        .across = "shadows",
        .most_rows = 3}}};
}

ReportPage splat_error_page() {
  return {
      "splat.error",
      "How far is a bounce by multiresolution splatting from the truth, and does it flicker?",
      {"FLIP: direct light is that of 64 samples a pixel in both pictures; `path` with one bounce. "
       "Without shadows: against pixel-by-pixel splatting of many more virtual lights, without "
       "shadows. Left out: without shadows against `path`.",
       "Flicker: mean second difference from picture to picture over mean radiance, while a light "
       "moves by a centimetre or two a picture."},
      {{.caption = "FLIP of indirect light",
        .rows = {{"scene", "scene"}, {"lights", "lights"}, {"passes", "passes"}},
        .columns = {{"splat.flip", "with shadows (wanted: 0.10)"},
                    {"flip_without", "without shadows (wanted: 0.08)"},
                    {"flip_left_out", "shadows left out"},
                    {"flip_direct", "no bounce at all"},
                    {"splat.flip", "the reference's own noise", 1, "", "reference_flip"}},
        .most_rows = 8},
       {.caption = "Choice of 256 virtual lights, error of one picture and flicker",
        .rows = {{"scene", "scene"}},
        .columns = {{"choice_rms", "relative RMS error"}, {"choice_flicker", "flicker"}},
        .most_rows = 1},
       {.caption = "Flicker under a light that moves, Cornell box",
        .rows = {{"technique", "technique"}},
        .columns = {{"splat.flicker", "flicker"},
                    {"splat.flicker", "processor ms", 1, "", "processor_ms"}},
        .most_rows = 3}}};
}

}  // namespace wellspring::test
