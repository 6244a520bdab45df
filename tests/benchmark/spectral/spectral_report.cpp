// SPDX-License-Identifier: Apache-2.0
// spectral: what the renderer's way to sample wavelengths is worth against others, what it costs
// against red, green and blue, and how exact its colours are.
#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <iterator>

#include "base/clock.h"
#include "light/kept/bake_file.h"
#include "light/kept/lamps.h"
#include "light/kept/map_file.h"
#include "light/technique/technique.h"
#include "benchmark/reports.h"
#include "scenes/lit_world.h"
#include "lobe_picture.h"
#include "pigment_rooms.h"
#include "pigments.h"
#include "show/exhibit/load/exhibit_load.h"
#include "spectrum/lamps.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using nlohmann::json;
using namespace scenes;

constexpr int steps[] = {1, 4, 16, 64, 256};  // clusters of a pixel
constexpr int most_steps = int(std::size(steps));

struct Estimating {
  LobeEstimator how;
  const char* name;
};
constexpr Estimating estimators[] = {{LobeEstimator::mis, "mis"},
                                     {LobeEstimator::single, "single"},
                                     {LobeEstimator::naive, "naive"}};

std::string describe(const LobeMaterial& m) {
  return fmt::format("cos^{:.0f}, {:.2f} to {:.2f}", m.exponent, m.index_at_360, m.index_at_830);
}

// Holds errors by number of clusters, and a cluster's processor seconds.
struct LobeCurve {
  double shown[most_steps], linear[most_steps], seconds;
};

LobeCurve measure_curve(const LobePicture& picture, const LobePixels& truth, LobeEstimator how) {
  LobeCurve curve;
  for (int i = 0; i < most_steps; i++) {
    const double began = process_seconds_now();
    const LobePixels drawn = picture.draw(how, steps[i], 1);
    curve.seconds = (process_seconds_now() - began) / double(steps[i] * int(drawn.size()));
    curve.shown[i] = lobe_error(drawn, truth, true);
    curve.linear[i] = lobe_error(drawn, truth, false);
  }
  return curve;
}

// Returns how many clusters bring the error down to `wanted`, by straight lines between logarithms.
double clusters_for(const double (&errors)[most_steps], double wanted) {
  int i = 1;
  while (i + 1 < most_steps && errors[i] > wanted) i++;
  const double slope =
      std::log(double(steps[i]) / steps[i - 1]) / std::log(errors[i] / errors[i - 1]);
  return steps[i] * std::pow(wanted / errors[i], slope);
}

void measure_lobes(BenchReport& report, const LobeMaterial& material, int size) {
  const LobePicture picture(material, size);
  const LobePixels truth = picture.reference();
  LobeCurve curves[std::size(estimators)];
  json where = {{"scene", "stripes through a ball"}, {"material", describe(material)}};
  for (size_t k = 0; k < std::size(estimators); k++) {
    curves[k] = measure_curve(picture, truth, estimators[k].how);
    where["technique"] = estimators[k].name;
    for (int i = 0; i < most_steps; i++) {
      where["clusters"] = steps[i];
      report.add("spectral.lobe.error", curves[k].shown[i], "1", where);
      report.add("spectral.lobe.error_linear", curves[k].linear[i], "1", where);
    }
    where.erase("clusters");
    report.add("spectral.lobe.slope",
               std::log(curves[k].shown[most_steps - 1] / curves[k].shown[1]) /
                   std::log(double(steps[most_steps - 1]) / steps[1]),
               "1", where);
    report.add("spectral.lobe.cluster_ns", 1e9 * curves[k].seconds, "ns", where);
  }
  where.erase("technique");
  const LobeCurve &mis = curves[0], &single = curves[1];
  const double last = steps[most_steps - 1], cost = mis.seconds / single.seconds;
  const double share = clusters_for(mis.shown, single.shown[most_steps - 1]) / last;
  report.add("spectral.lobe.clusters_ratio", share, "1", where);
  report.add("spectral.lobe.time_ratio", share * cost, "1", where);
  report.add("spectral.lobe.linear_time_ratio",
             clusters_for(mis.linear, single.linear[most_steps - 1]) / last * cost, "1", where);
  report.add("spectral.lobe.mis_4_over_single_64", mis.shown[1] / single.shown[3], "1", where);
}

void sweep_lobes(BenchReport& report, int size, int count) {
  double most = 0;
  for (const double exponent : {10.0, 100.0, 1000.0, 4000.0, 100000.0})
    for (const double index : {1.2, 1.25, 1.35, 1.5, 1.9}) {
      const LobeMaterial material{index, 1.2, exponent};
      const LobePicture picture(material, size);
      const double single = picture.variance(LobeEstimator::single, count, 1);
      json where = {{"exponent", exponent}, {"index_at_360", fmt::format("{:.2f}", index)}};
      const double ratio = picture.variance(LobeEstimator::mis, count, 1) / single;
      most = std::max(most, ratio);
      where["technique"] = "mis";
      report.add("spectral.sweep.variance_ratio", ratio, "1", where);
      where["technique"] = "naive";
      report.add("spectral.sweep.naive_ratio",
                 picture.variance(LobeEstimator::naive, count, 1) / single, "1", where);
    }
  report.add("spectral.sweep.most", most, "1", {{"technique", "mis"}});
}

// Returns the Cornell box; `gloss`: under a varnish, so that none of its surfaces is Lambertian.
Scene make_box(bool spectral, bool gloss) {
  Scene scene = make_cornell_box();
  int lamp = -1;
  for (int i = 0; i < int(scene.materials.size()); i++) {
    Material& material = scene.materials[size_t(i)];
    if (max_component(material.emission) > 0) lamp = i;
    else if (gloss) material.ior = 1.5f, material.roughness = 0.3f;
  }
  if (!spectral) return scene;
  // Materials are added to while they are read.
  for (size_t i = 1; i < scene.materials.size(); i++)
    if (int(i) != lamp) {
      Material material = scene.materials[i];
      upsample_base_color(scene, material);
      scene.materials[i] = material;
    }
  scene.lamps.push_back({"lamp", {}, {lamp}});
  set_lamp_spectrum(scene, scene.lamps[0], add_spectrum(scene, "A", find_lamp("A")->power));
  return scene;
}

void measure_cost(BenchReport& report, bool gloss, bool quick) {
  const LitWorld plain(make_box(false, gloss)), spectral(make_box(true, gloss));
  const View view = cornell_view(plain.scene, quick ? 160 : 320, quick ? 120 : 240);
  const Technique& path = *find_technique("path");
  std::vector<double> ratios, clocks, rates;
  for (int turn = 0; turn < (quick ? 3 : 9); turn++) {
    double processor[2], clock[2];
    StillSettings settings;
    settings.spp = 8;
    settings.seed = uint64_t(turn);
    for (int which : {0, 1}) {
      const LitWorld& lit = which ? spectral : plain;
      const double began = process_seconds_now(), at = seconds_now();
      render_still(path, lit.world, lit.lights, view, settings);
      processor[which] = process_seconds_now() - began;
      clock[which] = seconds_now() - at;
    }
    if (turn == 0) continue;  // caches are cold
    ratios.push_back(processor[1] / processor[0]);
    clocks.push_back(clock[1] / clock[0]);
    rates.push_back(8.0 * view.width * view.height / clock[1]);
  }
  const json where = {{"scene", gloss ? "Cornell box, varnished" : "Cornell box"},
                      {"technique", "path"}};
  report.add("lamps.time_ratio", quantile(ratios, 0.5), "1", where);
  report.add("lamps.clock_ratio", quantile(clocks, 0.5), "1", where);
  report.add("lamps.samples_a_second", quantile(rates, 0.5), "1/s", where);
}

json add_colors(BenchReport& report, const std::vector<double>& all, json where) {
  double sum = 0;
  for (const double one : all) sum += one;
  report.add("lamps.de00_mean", sum / double(all.size()), "dE00", where);
  report.add("lamps.de00_max", *std::ranges::max_element(all), "dE00", where);
  return where;
}

void append(const std::vector<double>& from, std::vector<double>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void measure_colors(BenchReport& report, const Pigments& pigments, int samples) {
  std::vector<double> once, twice;
  double negative = 0;
  for (const char* lamp : lamp_dial) {
    const PigmentErrors errors = render_pigments(pigments.reflectances, lamp, samples);
    append(errors.once, once), append(errors.twice, twice);
    negative += errors.negative / double(std::size(lamp_dial));
    report.add("lamps.lamp_de00_max", *std::ranges::max_element(errors.twice), "dE00",
               {{"lamp", lamp}, {"samples", samples}});
  }
  auto where = [&](const char* reflections) {
    return json{{"pigments", pigments.kind},
                {"technique", "path"},
                {"reflections", reflections},
                {"samples", samples}};
  };
  add_colors(report, once, where("one"));
  report.add("lamps.negative_samples", negative, "1", add_colors(report, twice, where("two")));
}

void measure_dial(BenchReport& report, const Pigments& pigments) {
  std::vector<double> once, twice;
  for (const PigmentErrors& errors : turn_dial(pigments.reflectances, lamp_dial))
    append(errors.once, once), append(errors.twice, twice);
  const json where = {{"pigments", pigments.kind}, {"technique", "map"}};
  auto with = [&](const char* reflections) {
    json all = where;
    all["reflections"] = reflections;
    return all;
  };
  add_colors(report, once, with("one"));
  add_colors(report, twice, with("two"));
}

// Measures what a turn of the castle's dial takes until pictures can be drawn by its light.
void measure_dial_time(BenchReport& report, const BenchOptions& options) {
  const Exhibit castle = load_exhibit(options.content + "/castle");
  World world(castle.scene);
  const auto has_dial = [](const Lamp& lamp) { return !lamp.dial.empty(); };
  const auto lamp = std::ranges::find_if(castle.scene.lamps, has_dial);
  Lights all = make_lights(world);
  all.maps = all.known =
      load_map(world, shipped_light(castle.folder), hash_scene(castle.scene)).map;
  if (!all.maps || lamp == castle.scene.lamps.end()) return;
  const auto cells = std::make_shared<LampCells>(make_lamp_cells(world, *all.maps));
  const int number = int(lamp - castle.scene.lamps.begin());
  std::vector<double> maps, changes;
  for (int turn = 0; turn < (options.quick ? 5 : 25); turn++) {
    const LampLevels before = world.lamp_levels();
    world.set_lamp(number, {lamp_full, uint8_t(1 + turn % int(lamp->dial.size()))});
    const double began = seconds_now();
    const Lights lit = relit(all, world);
    maps.push_back(seconds_now() - began);
    const LightChange change(castle.scene, all, cells, before, world.lamp_levels());
    changes.push_back(seconds_now() - began);
  }
  const json where = {{"scene", "castle"}};
  report.add("lamps.dial_map_ms", 1e3 * quantile(maps, 0.5), "ms", where);
  report.add("lamps.dial_ms", 1e3 * quantile(changes, 0.5), "ms", where);
  report.add("lamps.dial_most_ms", 1e3 * quantile(changes, 1), "ms", where);
  report.add("lamps.map_mib", double(memory_bytes(*all.maps)) / (1 << 20), "MiB", where);
  report.add("lamps.layers", double(all.maps->layers->size()), "1", where);
}

}  // namespace

void bench_spectral(BenchReport& report, const BenchOptions& options) {
  const int size = options.quick ? 24 : 64;
  measure_lobes(report, {1.35, 1.2, 1000}, size);
  measure_lobes(report, {1.5, 1.2, 4000}, size);
  sweep_lobes(report, options.quick ? 8 : 16, options.quick ? 256 : 2048);
}

void bench_spectral_color(BenchReport& report, const BenchOptions& options) {
  for (const bool gloss : {false, true}) measure_cost(report, gloss, options.quick);
  const Pigments pigments = find_pigments(options);
  for (const int samples : {64, options.quick ? 1024 : 4096})
    measure_colors(report, pigments, samples);
  measure_dial(report, pigments);
  measure_dial_time(report, options);
}

ReportPage spectral_page() {
  return {
      "spectral",
      "What are clusters of wavelengths worth that multiple importance sampling keeps together, "
      "what do they cost, and how exact are their colours?",
      {"Error: mean absolute difference of pixels, cut to 0 to 1, from sums over every nanometre, "
       "of "
       "stripes of light through a ball that parts colours into Phong's lobes. mis: the "
       "renderer's; "
       "single: one wavelength, as pbrt-v4 has it after dispersion; naive: all, by the chosen "
       "one's "
       "density. The paper, by 16 clusters: 0.0263 against 0.134 (cos^1000), 0.0739 against 0.129.",
       "Wanted: a ninth of the time (cos^1000), and no variance above single's."},
      {{.caption = "Error by clusters a pixel",
        .rows = {{"material", "lobe, index"}, {"technique", "by"}},
        .columns = {{"spectral.lobe.error", "error", 1, "1"}},
        .across = "clusters",
        .most_rows = 6},
       {.caption = "MIS over single at equal error",
        .rows = {{"material", "lobe, index"}},
        .columns = {{"spectral.lobe.clusters_ratio", "clusters", 1, "1"},
                    {"spectral.lobe.time_ratio", "processor time", 1, "1"},
                    {"spectral.lobe.linear_time_ratio", "the same, uncut", 1, "1"},
                    {"spectral.lobe.mis_4_over_single_64", "4 clusters over 64", 1, "1"}},
        .most_rows = 2},
       {.caption = "Variance of MIS over that of single, by exponent and index at 360 nm",
        .rows = {{"exponent", "exponent"}},
        .columns = {{"spectral.sweep.variance_ratio", "ratio", 1, "1"}},
        .across = "index_at_360",
        .most_rows = 5}}};
}

ReportPage spectral_color_page() {
  return {
      "spectral.color",
      "What does light by wavelength cost, and how exact are its colours?",
      {"Time: of walls and lamp by wavelength over those in red, green and blue; wanted: 1.25.",
       "Colours: dE00 of light that one or two of 54 pigments sent back, under eight lamps, from "
       "sums over every nanometre. path: wanted 0.3 in the mean, 1.0 at most; map: baked under one "
       "lamp, whose dial is turned to the others: 0.5 and 2.5.",
       "Dial: from the turn to new light on all surfaces; wanted: 50 ms and a drawn picture."},
      {{.rows = {{"scene", "scene"}},
        .columns = {{"lamps.time_ratio", "time by wavelength over that in colours", 1, "1"},
                    {"lamps.clock_ratio", "by the clock", 1, "1"}},
        .most_rows = 2},
       {.rows = {{"technique", "by"}, {"reflections", "reflections"}},
        .columns = {{"lamps.de00_mean", "mean", 1, ""}, {"lamps.de00_max", "max", 1, ""}},
        .most_rows = 4},
       {.rows = {{"scene", "dial turned in"}},
        .columns = {{"lamps.dial_ms", "until pictures can be drawn", 1, "ms"},
                    {"lamps.dial_most_ms", "most", 1, "ms"},
                    {"lamps.map_mib", "map", 1, "MiB"},
                    {"lamps.layers", "layers", 1, "1"}},
        .most_rows = 1}}};
}

}  // namespace wellspring::test
