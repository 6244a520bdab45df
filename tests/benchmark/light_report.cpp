// SPDX-License-Identifier: Apache-2.0
// Error over time of every technique on every scene: pictures of 1, 2, 4, ... samples a pixel
// against a converged `path`, until a picture would take longer than its share of the run.
#include <cstdio>
#include <ctime>

#include "base/clock.h"
#include "frame/picture_file.h"
#include "light_curve.h"
#include "light_reference.h"
#include "light_scenes.h"
#include "plot.h"
#include "report.h"

namespace wellspring::test {
namespace {

// Seconds, on whatever machine: the run's length is bounded, its figures are as good as it allows.
struct Budget {
  int width, height;
  double reference, longest_picture;
};
Budget budget_of(const BenchOptions& options) {
  return options.quick ? Budget{192, 108, 9, 1.2} : Budget{320, 180, 80, 10};
}

void add_curve(BenchReport& report, const std::string& scene, const Technique& technique,
               double preparation, const std::vector<CurvePoint>& curve) {
  std::string prefix = std::string("light.") + technique.name;
  for (const CurvePoint& p : curve) {
    nlohmann::json fields = {{"scene", scene},
                             {"technique", technique.name},
                             {"spp", p.spp},
                             {"seconds", p.seconds},
                             {"cpu_seconds", p.cpu_seconds}};
    if (technique.prepare) fields["preparation_seconds"] = preparation;
    report.add(prefix + ".flip", p.flip, "1", fields);
    report.add(prefix + ".rmse", p.rmse, "radiance", fields);
    report.add(prefix + ".relative_mse", p.relative_mse, "1", fields);
  }
}

constexpr double flip_level = 0.1;

std::vector<CurvePoint> by_cpu(std::vector<CurvePoint> curve) {
  for (CurvePoint& p : curve) p.seconds = p.cpu_seconds;
  return curve;
}

void compare_times(BenchReport& report, const std::string& scene, const std::string& technique,
                   const std::vector<CurvePoint>& curve, const std::vector<CurvePoint>& path) {
  Reached ours = time_to_flip(curve, flip_level), reference = time_to_flip(path, flip_level);
  if (!(ours.seconds > 0) || !(reference.seconds > 0)) return;
  double cpu = time_to_flip(by_cpu(curve), flip_level).seconds,
         path_cpu = time_to_flip(by_cpu(path), flip_level).seconds;
  report.add("light." + technique + ".time_to_flip_ratio", ours.seconds / reference.seconds, "1",
             {{"scene", scene},
              {"technique", technique},
              {"flip", flip_level},
              {"seconds", ours.seconds},
              {"path_seconds", reference.seconds},
              {"cpu_ratio", path_cpu > 0 ? cpu / path_cpu : 0},
              {"measured", ours.measured && reference.measured}});
}

// Adds how long visitors wait in the diffuse hall: the share of `path`'s time that the technique
// needs until its picture is as good.
void add_hall_ratio(BenchReport& report, const std::vector<CurvePoint>& curve,
                    const std::vector<CurvePoint>& path) {
  Reached ours = time_to_flip(by_cpu(curve), flip_level),
          reference = time_to_flip(by_cpu(path), flip_level);
  if (!(ours.seconds > 0) || !(reference.seconds > 0)) return;
  report.add("light.hall.instant_radiosity_over_path", ours.seconds / reference.seconds, "1",
             {{"scene", "diffuse_hall"},
              {"flip", flip_level},
              {"cpu_seconds", ours.seconds},
              {"path_cpu_seconds", reference.seconds},
              {"measured", ours.measured && reference.measured}});
}

Plot make_plot(const BenchScene& bench, const View& view, const Reference& reference) {
  char subtitle[200];
  std::snprintf(subtitle, sizeof subtitle,
                "%s. %dx%d; reference: path, %d samples a pixel, its own FLIP below %.3f",
                bench.about.c_str(), view.width, view.height, reference.spp, reference.flip);
  return {bench.name + ": error over time",
          subtitle,
          "processor time for the picture, all threads [s]",
          "mean FLIP against the reference",
          {},
          flip_level,
          "FLIP 0.10"};
}

void bench_scene(BenchReport& report, const BenchOptions& options, const BenchScene& bench) {
  Budget budget = budget_of(options);
  bool square = bench.name == "cornell_box";
  View view = bench_view(bench, square ? budget.height : budget.width, budget.height);
  World world(bench.scene);
  const Lights lights = make_lights(world);
  TransportSettings transport;
  transport.max_depth = bench.max_depth;
  Reference reference = make_reference(world, lights, view, transport, budget.reference);
  nlohmann::json about = {{"scene", bench.name},
                          {"spp", reference.spp},
                          {"seconds", reference.seconds},
                          {"width", view.width},
                          {"height", view.height}};
  report.add("light.reference.rmse", reference.rmse, "radiance", about);
  report.add("light.reference.relative_mse", reference.relative_mse, "1", about);
  report.add("light.reference.flip", reference.flip, "1", about);
  save_picture(options.plots + "light_" + bench.name + ".jpg", reference.frame, {});
  Plot plot = make_plot(bench, view, reference);
  std::vector<CurvePoint> path;
  for (const Technique& technique : techniques()) {
    Lights own = lights;
    double began = seconds_now();
    if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), own);
    double preparation = seconds_now() - began;
    std::vector<CurvePoint> curve = measure_curve(technique, world, own, view, transport,
                                                  reference.frame, budget.longest_picture);
    add_curve(report, bench.name, technique, preparation, curve);
    Curve drawn{technique.name, {}};
    if (preparation > 0.05) {
      char once[32];
      std::snprintf(once, sizeof once, " (+ %.1f s once)", preparation);
      drawn.name += once;
    }
    for (const CurvePoint& p : curve) drawn.points.push_back({p.cpu_seconds, p.flip});
    plot.curves.push_back(drawn);
    if (plot.curves.size() == 1) path = curve;  // the list begins with `path`
    else compare_times(report, bench.name, technique.name, curve, path);
    if (bench.name == "diffuse_hall" && std::string_view(technique.name) == "instant_radiosity")
      add_hall_ratio(report, curve, path);
  }
  save_svg(options.plots + "light_" + bench.name + ".svg", plot);
}

}  // namespace

void bench_light_error(BenchReport& report, const BenchOptions& options) {
  for (const BenchScene& bench : load_bench_scenes(options)) bench_scene(report, options, bench);
}

void bench_light_hall(BenchReport& report, const BenchOptions& options) {
  bench_scene(report, options, load_bench_scene(options, "diffuse_hall"));
}

// One frame of the Cornell box for somebody who waits for it.
void bench_light_frame(BenchReport& report, const BenchOptions& options) {
  BenchScene bench = load_bench_scene(options, "cornell_box");
  View view = bench_view(bench, 640, 480);
  World world(bench.scene);
  for (const Technique& technique : techniques()) {
    Lights lights = make_lights(world);
    if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), lights);
    StillSettings settings;
    settings.spp = 1;
    std::vector<double> seconds, cpu;
    for (int i = 0; i < (options.quick ? 5 : 15); i++) {
      settings.seed = uint64_t(i);
      double began = seconds_now();
      std::clock_t cpu_began = std::clock();
      render_still(technique, world, lights, view, settings);
      seconds.push_back(seconds_now() - began);
      cpu.push_back(double(std::clock() - cpu_began) / CLOCKS_PER_SEC);
    }
    report.add(std::string("light.") + technique.name + ".frame_ms", 1000 * quantile(seconds, 0.5),
               "ms",
               {{"scene", bench.name},
                {"technique", technique.name},
                {"width", 640},
                {"height", 480},
                {"cpu_ms", 1000 * quantile(cpu, 0.5)}});
  }
}

}  // namespace wellspring::test
