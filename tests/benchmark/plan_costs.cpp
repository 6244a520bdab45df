// SPDX-License-Identifier: Apache-2.0
#include "plan_costs.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/clock.h"
#include "crowd.h"
#include "drawn_picture.h"
#include "frame/disparity_code.h"
#include "image/image.h"
#include "light/technique/technique.h"
#include "picture/warp_picture.h"
#include "show/exhibit/load/exhibit_load.h"
#include "stroll.h"

namespace wellspring::test {
namespace {

struct Size {
  int width, height;
  double pixels() const { return double(width) * height; }
};
constexpr Size sizes[] = {{160, 90}, {320, 180}, {640, 360}, {1280, 720}};
// Rungs of resolution of keyframes (show::plan_keyframe), which keep a border for turns.
constexpr double rungs[] = {1, 0.75, 0.5, 0.375}, border = 1.04;
constexpr double guessed = 30, weighed = 30e3;  // as in show/state/capacity.cpp
constexpr int quality = 82;                     // JPEGs have it, as the server begins

void add(BenchReport& report, const std::string& name, double value, const std::string& unit,
         const Size& size) {
  report.add("load.plan.cost." + name, value, unit,
             {{"scene", "castle"},
              {"size", std::to_string(size.width) + "x" + std::to_string(size.height)},
              {"width", size.width},
              {"height", size.height}});
}
void add(BenchReport& report, const std::string& name, double value, const std::string& unit) {
  report.add("load.plan.cost." + name, value, unit, {{"scene", "castle"}});
}

double rung_of(double width) {
  const auto found = std::ranges::find_if(rungs, [&](double one) { return width >= border * one; });
  return found == std::end(rungs) ? rungs[3] : *found;
}

// Holds what keyframes cost of one visitor, who strolls with a page that draws by itself.
struct MeasuredSize {
  Size size;
  CrowdSeen seen;
  // Core-seconds of one, in the mean, each divided by its scale, as the server notes them.
  double cost = 0;
  double mean_scale = 1, mean_reverse = 1, mean_square = 1;
};

MeasuredSize measure_keyframes(const BenchOptions& options, const Size& size) {
  MeasuredSize drawn{size, measure_crowd(options, {.visitors = 1,
                                                   .width = size.width,
                                                   .height = size.height,
                                                   .local = true,
                                                   .seconds = options.quick ? 8.0 : 20.0})};
  CrowdSeen& seen = drawn.seen;
  // The server tells a mean for which a guess counts as so many keyframes.
  const char* name = "picture_drawn_seconds_a_megapixel";
  const double before = seen.begun["pictures_drawn_total"],
               after = seen.ended["pictures_drawn_total"];
  const double noted =
      ((guessed + after) * seen.ended[name] - (guessed + before) * seen.begun[name]) /
      std::max(after - before, 1.0);
  drawn.cost = 1e-6 * noted * (size.pixels() + weighed);
  double sum = 0, reverse = 0, square = 0;
  for (const double width : seen.scales) {
    const double scale = rung_of(width);
    sum += scale, reverse += 1 / scale, square += scale * scale;
  }
  if (const double count = double(seen.scales.size()); count > 0)
    drawn.mean_scale = sum / count, drawn.mean_reverse = reverse / count,
    drawn.mean_square = square / count;
  return drawn;
}

// A keyframe of p pixels costs fixed + a_pixel * p: least squares of relative errors.
struct Line {
  double fixed = 0, a_pixel = 0;
};
Line fit(const std::vector<MeasuredSize>& all) {
  double uu = 0, uv = 0, vv = 0, u1 = 0, v1 = 0;
  for (const MeasuredSize& one : all) {
    const double u = one.mean_reverse / one.cost, v = one.mean_scale * one.size.pixels() / one.cost;
    uu += u * u, uv += u * v, vv += v * v, u1 += u, v1 += v;
  }
  const double det = uu * vv - uv * uv;
  return {(u1 * vv - v1 * uv) / det, (v1 * uu - u1 * uv) / det};
}

// Returns the share of a keyframe that one core does alone, by how long it took on the cores
// that other programs left.
double serial_share(const MeasuredSize& drawn, const Line& line, double cores) {
  const double work = line.fixed + line.a_pixel * drawn.size.pixels() * drawn.mean_square;
  const double seconds = 0.001 * drawn.seen.metrics.at("visitor_drawn_after_milliseconds");
  const double free = cores / (1 + drawn.seen.others);
  double width = work / seconds * cores / free;
  width = std::clamp(width, 1.0, cores);
  return cores > 1 ? (1 / width - 1 / cores) / (1 - 1 / cores) : 0;
}

// Times what is made of a keyframe, in processor time, along a stroll's first turn.
void measure_functions(BenchReport& report, const BenchOptions& options) {
  const Exhibit castle = load_exhibit(options.content + "/castle");
  World world(castle.scene);
  world.commit();
  Lights lights = make_lights(world);
  const VisibilityPass visibility(world, lights);
  const int turns = options.quick ? 6 : 24;
  for (const Size& size : sizes) {
    double warping = 0, finished = 0, keyframes = 0;
    Viewpoint at = castle.viewpoints[size_t(castle.start)].view;
    DrawnPicture drawn;
    Keyframe keyframe;
    WarpScratch scratch;
    Image8 warped;
    std::vector<uint8_t> bytes;
    for (int i = 0; i < turns; i++) {
      at.yaw += 0.3f;
      const View view = make_view(castle.scene, at, size.width, size.height);
      draw_picture(visibility, view, drawn);
      make_keyframe(view, drawn.image, drawn.depth, keyframe);
      Viewpoint later = at;
      later.yaw += 0.02f;
      const View now = make_view(castle.scene, later, size.width, size.height);
      warp_picture(keyframe, now, 1, scratch, warped);  // the second finds its memory
      double began = process_seconds_now();
      warp_picture(keyframe, now, 1, scratch, warped);
      warping += process_seconds_now() - began;
      bytes.clear();
      began = thread_seconds_now();
      encode_jpeg(warped, quality, false, bytes);
      finished += thread_seconds_now() - began;
      began = thread_seconds_now();
      encode_disparity(keyframe.disparity, size.width, size.height, disparity_unit(view), bytes);
      keyframes += thread_seconds_now() - began;
    }
    add(report, "warp", warping / turns, "s", size);
    add(report, "encode_picture", finished / turns, "s", size);
    add(report, "encode_keyframe", (finished + keyframes) / turns, "s", size);
  }
}

}  // namespace

void measure_plan_costs(BenchReport& report, const BenchOptions& options) {
  const double cores = std::max(1u, std::thread::hardware_concurrency());
  add(report, "cores", cores, "");
  measure_functions(report, options);
  std::vector<MeasuredSize> all;
  for (const Size& size : sizes) all.push_back(measure_keyframes(options, size));
  const Line line = fit(all);
  std::vector<double> serial, samples, wide, ticks, memory;
  for (MeasuredSize& one : all) {
    const Size& size = one.size;
    add(report, "draw", std::max(line.fixed + line.a_pixel * size.pixels(), 1e-6), "s", size);
    add(report, "keyframe_mean", one.cost, "s", size);
    add(report, "others", one.seen.others, "", size);
    const double side = std::sqrt(one.mean_square);
    add(report, "keyframe_bytes", one.seen.bytes, "B",
        {int(size.width * side), int(size.height * side)});
    const double own = one.seen.metrics["visitor_memory_bytes"];
    add(report, "visitor_memory", own, "B", size);
    memory.push_back(one.seen.resident - own);
    serial.push_back(serial_share(one, line, cores));
    samples.push_back(one.seen.metrics["samples_per_second"] / cores);
    wide.push_back(one.seen.growth("surroundings_drawn_total"));
    ticks.push_back(0.001 * one.seen.metrics["tick_milliseconds"]);
  }
  for (const Size& size : sizes) {
    const CrowdSeen seen = measure_crowd(options, {.visitors = 1,
                                                   .width = size.width,
                                                   .height = size.height,
                                                   .seconds = options.quick ? 4.0 : 10.0});
    add(report, "picture_bytes", seen.bytes, "B", size);
  }
  constexpr int few = 8;
  const CrowdSeen crowd =
      measure_crowd(options, {.visitors = few, .width = 160, .height = 90, .local = true});
  const double tick = quantile(ticks, 0.5);
  const double more = 0.001 * crowd.metrics.at("tick_milliseconds") - tick;
  add(report, "serial", quantile(serial, 0.5), "");
  add(report, "samples", quantile(samples, 0.5), "1/s");
  add(report, "wide_rate", quantile(wide, 0.5), "1/s");
  add(report, "server_memory", quantile(memory, 1), "B");
  add(report, "tick", tick, "s");
  add(report, "tick_visitor", std::max(more / (few - 1), 0.0), "s");
}

}  // namespace wellspring::test
