// SPDX-License-Identifier: Apache-2.0
// Error over time of every technique on every scene: pictures of 1, 2, 4, ... samples a pixel
// against a converged `path`, until a picture would take longer than its share of the run.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/clock.h"
#include "frame/compare.h"
#include "frame/flip.h"
#include "light_reference.h"
#include "light_scenes.h"
#include "plot.h"
#include "report.h"

namespace wellspring {
namespace {

// Seconds, on whatever machine: the run's length is bounded, its figures are as good as it allows.
struct Budget {
  int width, height;
  double reference, longest_picture;
};
Budget budget_of(const BenchOptions& options) {
  return options.quick ? Budget{192, 108, 9, 1.2} : Budget{320, 180, 100, 16};
}

struct Point {
  int spp = 0;
  double seconds = 0, flip = 0, rmse = 0, relative_mse = 0;
};

// Quick pictures are timed thrice and the median counts; the picture is the same each time.
Point measure(const Technique& technique, const World& world, const Lights& lights,
              const View& view, const StillSettings& settings, const Frame& reference) {
  std::vector<double> seconds;
  Frame frame;
  do {
    double began = seconds_now();
    frame = render_still(technique, world, lights, view, settings);
    seconds.push_back(seconds_now() - began);
  } while (seconds.size() < 3 && seconds[0] < 0.1);
  return {settings.spp, quantile(seconds, 0.5), flip(frame, reference), rmse(frame, reference),
          relative_mse(frame, reference)};
}

std::vector<Point> measure_curve(const Technique& technique, const World& world,
                                 const Lights& lights, const View& view,
                                 const TransportSettings& transport, const Frame& reference,
                                 double longest) {
  std::vector<Point> curve;
  StillSettings settings;
  settings.transport = transport;
  constexpr int most = 1 << 14;
  for (settings.spp = 1; settings.spp <= most; settings.spp *= 2) {
    settings.seed = 1000 + uint64_t(settings.spp);
    curve.push_back(measure(technique, world, lights, view, settings, reference));
    if (2 * curve.back().seconds > longest) break;
  }
  return curve;
}

// When the curve falls to this FLIP: between two points along the line through their logarithms;
// a little beyond the last one along the line through the last three. 0: it does not fall so far.
struct Reached {
  double seconds = 0;
  bool measured = true;  // else extrapolated
};
Reached time_to_flip(const std::vector<Point>& curve, double level) {
  if (curve.empty()) return {};
  if (curve[0].flip <= level) return {curve[0].seconds, true};
  auto along = [&](const Point& a, const Point& b) {
    double slope = std::log(b.flip / a.flip) / std::log(b.seconds / a.seconds);
    return slope < -0.01 ? a.seconds * std::pow(level / a.flip, 1 / slope) : 0;
  };
  for (size_t i = 1; i < curve.size(); i++)
    if (curve[i].flip <= level) return {along(curve[i - 1], curve[i]), true};
  constexpr double farthest = 8;  // times the last point's
  double seconds = curve.size() > 2 ? along(curve[curve.size() - 3], curve.back()) : 0;
  return {seconds < farthest * curve.back().seconds ? seconds : 0, false};
}

void add_curve(BenchReport& report, const std::string& scene, const Technique& technique,
               double preparation, const std::vector<Point>& curve) {
  std::string prefix = std::string("light.") + technique.name;
  for (const Point& p : curve) {
    nlohmann::json fields = {{"scene", scene},
                             {"technique", technique.name},
                             {"spp", p.spp},
                             {"seconds", p.seconds}};
    if (technique.prepare) fields["preparation_seconds"] = preparation;
    report.add(prefix + ".flip", p.flip, "1", fields);
    report.add(prefix + ".rmse", p.rmse, "radiance", fields);
    report.add(prefix + ".relative_mse", p.relative_mse, "1", fields);
  }
}

constexpr double flip_level = 0.1;

void compare_times(BenchReport& report, const std::string& scene, const std::string& technique,
                   const std::vector<Point>& curve, const std::vector<Point>& path) {
  Reached ours = time_to_flip(curve, flip_level), reference = time_to_flip(path, flip_level);
  if (!(ours.seconds > 0) || !(reference.seconds > 0)) return;
  report.add("light." + technique + ".time_to_flip_ratio", ours.seconds / reference.seconds, "1",
             {{"scene", scene},
              {"technique", technique},
              {"flip", flip_level},
              {"seconds", ours.seconds},
              {"path_seconds", reference.seconds},
              {"measured", ours.measured && reference.measured}});
}

Plot make_plot(const BenchScene& bench, const View& view, const Reference& reference) {
  char subtitle[200];
  std::snprintf(subtitle, sizeof subtitle,
                "%s. %dx%d; reference: path, %d samples a pixel, its own FLIP below %.3f",
                bench.about.c_str(), view.width, view.height, reference.spp, reference.flip);
  return {bench.name + ": error over time", subtitle, "time for the picture [s]",
          "mean FLIP against the reference", {}, flip_level, "FLIP 0.10"};
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
  Plot plot = make_plot(bench, view, reference);
  std::vector<Point> path;
  for (const Technique& technique : techniques()) {
    Lights own = lights;
    double began = seconds_now();
    if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), own);
    double preparation = seconds_now() - began;
    std::vector<Point> curve = measure_curve(technique, world, own, view, transport,
                                             reference.frame, budget.longest_picture);
    add_curve(report, bench.name, technique, preparation, curve);
    Curve drawn{technique.name, {}};
    if (preparation > 0.05) {
      char once[32];
      std::snprintf(once, sizeof once, " (+ %.1f s once)", preparation);
      drawn.name += once;
    }
    for (const Point& p : curve) drawn.points.push_back({p.seconds, p.flip});
    plot.curves.push_back(drawn);
    if (plot.curves.size() == 1) path = curve;  // the list begins with `path`
    else compare_times(report, bench.name, technique.name, curve, path);
  }
  save_svg(options.plots + "light_" + bench.name + ".svg", plot);
}

}  // namespace

void bench_light_error(BenchReport& report, const BenchOptions& options) {
  for (const BenchScene& bench : load_bench_scenes(options)) bench_scene(report, options, bench);
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
    std::vector<double> seconds;
    for (int i = 0; i < (options.quick ? 5 : 15); i++) {
      settings.seed = uint64_t(i);
      double began = seconds_now();
      render_still(technique, world, lights, view, settings);
      seconds.push_back(seconds_now() - began);
    }
    report.add(std::string("light.") + technique.name + ".frame_ms", 1000 * quantile(seconds, 0.5),
               "ms",
               {{"scene", bench.name}, {"technique", technique.name}, {"width", 640}, {"height", 480}});
  }
}

}  // namespace wellspring
