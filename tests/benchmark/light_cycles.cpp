// SPDX-License-Identifier: Apache-2.0
#include "light_cycles.h"

#include <oneapi/tbb/global_control.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "base/clock.h"
#include "base/load_error.h"
#include "cycles_job.h"
#include "light/technique/technique.h"
#include "light_scenes.h"
#include "picture_pair.h"
#include "world/load/scene_load.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

constexpr int threads = 4, max_depth = 8;

// A case is a file, and whether its metals are kept or Lambertian (cycles_job.h).
struct Case {
  const char* name;
  bool is_castle, metals;
};
constexpr Case cases[] = {{"cornell_box", false, false},
                          {"metal_box", false, true},
                          {"castle", true, false},
                          {"castle_metals", true, true}};

// A folder that goes when its owner does.
struct Workspace {
  fs::path folder = fs::temp_directory_path() / ("wellspring_cycles_" + std::to_string(getpid()));
  Workspace() { fs::create_directories(folder); }
  ~Workspace() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
};

PicturePair render_ours(const World& world, const Lights& lights, const View& view, int spp,
                        uint64_t seed) {
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  StillSettings settings;
  settings.spp = spp;
  settings.transport.max_depth = max_depth;
  settings.seed = seed;
  double began = seconds_now(), began_processor = process_seconds_now();
  PicturePair pair;
  pair.a = render_still(*find_technique("path"), world, lights, view, settings);
  settings.seed = seed + 1;
  pair.b = render_still(*find_technique("path"), world, lights, view, settings);
  pair.seconds = (seconds_now() - began) / 2;
  pair.processor_seconds = (process_seconds_now() - began_processor) / 2;
  return pair;
}

// Says what our renderer needs until its noise is as low as theirs: samples are doubled until it is
// below, and a power law gives the time between the last two steps.
struct CyclesReached {
  PicturePair pair;
  int spp = 4;
  double seconds = 0, processor_seconds = 0;
};
CyclesReached reach_noise(const World& world, const Lights& lights, const View& view, double target,
                          int most) {
  CyclesReached reached;
  PicturePair before;
  double before_error = 0;
  for (;; reached.spp *= 2) {
    reached.pair = render_ours(world, lights, view, reached.spp, uint64_t(reached.spp) * 2);
    double error = noise(reached.pair);
    auto interpolate = [&](double last, double now) {
      if (!(error <= target && before_error > target)) return now;
      return last *
             std::pow(now / last, std::log(before_error / target) / std::log(before_error / error));
    };
    reached.seconds = interpolate(before.seconds, reached.pair.seconds);
    reached.processor_seconds =
        interpolate(before.processor_seconds, reached.pair.processor_seconds);
    if (error <= target || reached.spp >= most) return reached;
    before_error = error;
    before = reached.pair;
  }
}

View view_of(const BenchOptions& options, const Case& one, const Scene& scene) {
  int height = options.quick ? 136 : 272;
  if (one.is_castle)
    return bench_view(load_bench_scene(options, "castle"), height * 16 / 9 / 8 * 8, height);
  if (scene.viewpoints.empty()) throw LoadError(one.name, "/cameras", "has no camera");
  const Viewpoint& c = scene.viewpoints[0];
  return make_view(scene, c.position, c.yaw, c.pitch, c.fov, height, height);
}

void bench_case(BenchReport& report, const BenchOptions& options, const Case& one) {
  Workspace workspace;
  fs::path shared = workspace.folder / "shared.glb";
  fs::path file = one.is_castle ? fs::path(options.content) / "castle/scene.glb"
                                : fs::path(options.scenes) / (one.name + std::string(".glb"));
  write_shared_copy(file, one.metals, shared);
  Scene scene = load_scene(shared.string());
  scene.environment = {};
  View view = view_of(options, one, scene);
  int samples = options.quick ? 16 : 64;
  std::vector<CyclesRender> renders = {{samples, 1, {}, 0, 0}, {samples, 2, {}, 0, 0}};
  fs::path script = fs::path(options.scenes) / "../cycles/render.py";
  render_by_cycles(script, shared, view, max_depth, threads, workspace.folder,
                   options.quick ? 120 : 900, renders);
  PicturePair theirs{renders[0].frame, renders[1].frame,
                     (renders[0].seconds + renders[1].seconds) / 2,
                     (renders[0].processor_seconds + renders[1].processor_seconds) / 2};
  World world(scene);
  Lights lights = make_lights(world);
  const double target = noise(theirs);
  CyclesReached ours = reach_noise(world, lights, view, target, 16 * samples);
  Agreement agreement = compare_pairs(ours.pair, theirs);
  nlohmann::json fields = {{"scene", one.name},
                           {"size", std::to_string(view.width) + "x" + std::to_string(view.height)},
                           {"threads", threads},
                           {"rmse", target},
                           {"cycles_samples", samples},
                           {"cycles_seconds", theirs.seconds},
                           {"cycles_processor_seconds", theirs.processor_seconds},
                           {"path_samples", ours.spp},
                           {"path_seconds", ours.seconds},
                           {"path_processor_seconds", ours.processor_seconds}};
  nlohmann::json of_scene = {{"scene", one.name}};
  report.add("light.path.cycles_time_ratio", ours.seconds / theirs.seconds, "1", fields);
  report.add("light.path.cycles_processor_ratio", ours.processor_seconds / theirs.processor_seconds,
             "1", of_scene);
  report.add("light.path.cycles_relative_mean", agreement.relative_mean, "1",
             {{"scene", one.name}, {"standard_error", agreement.relative_error}});
  report.add("light.path.cycles_block_z", agreement.block_z, "1", of_scene);
  report.add("light.path.cycles_block_correlation", agreement.correlation, "1",
             {{"scene", one.name}, {"standard_error", agreement.correlation_error}});
}

}  // namespace

void bench_light_cycles(BenchReport& report, const BenchOptions& options) {
  if (!has_blender()) {
    std::cout << "light.path.cycles_*: skipped, no blender on the PATH\n";
    return;
  }
  for (const Case& one : cases) {
    if (!options.cycles_case.empty() && options.cycles_case != one.name) continue;
    try {
      bench_case(report, options, one);
    } catch (const std::runtime_error& error) {  // no numpy, another Blender, no time
      std::cout << "light.path.cycles_*: " << one.name << " skipped: " << error.what() << "\n";
    }
  }
}

}  // namespace wellspring::test
