// SPDX-License-Identifier: Apache-2.0
#include "light_cycles.h"

#include <oneapi/tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

#include "base/clock.h"
#include "cycles_job.h"
#include "light/technique.h"
#include "light_scenes.h"
#include "picture_pair.h"
#include "world/scene_load.h"

namespace wellspring {
namespace {

namespace fs = std::filesystem;

constexpr int threads = 4;

// A folder that goes when its owner does.
struct Workspace {
  fs::path folder = fs::temp_directory_path() / ("wellspring_cycles_" + std::to_string(getpid()));
  Workspace() { fs::create_directories(folder); }
  ~Workspace() {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  }
};

PicturePair render_ours(const World& world, const Lights& lights, const View& view, int max_depth,
                        int spp, uint64_t seed) {
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
  StillSettings settings;
  settings.spp = spp;
  settings.transport.max_depth = max_depth;
  settings.seed = seed;
  double began = seconds_now();
  PicturePair pair;
  pair.a = render_still(*find_technique("path"), world, lights, view, settings);
  settings.seed = seed + 1;
  pair.b = render_still(*find_technique("path"), world, lights, view, settings);
  pair.seconds = (seconds_now() - began) / 2;
  return pair;
}

void bench_scene(BenchReport& report, const BenchOptions& options, const std::string& name,
                 const fs::path& file) {
  Workspace workspace;
  fs::path matte = workspace.folder / "matte.glb";
  write_matte_copy(file, matte);
  Scene scene = load_scene(matte.string());
  scene.environment = {};
  BenchScene bench = load_bench_scene(options, name);
  int max_depth = bench.max_depth, height = options.quick ? 136 : 272;
  View view = bench_view(bench, name == "cornell_box" ? height : height * 16 / 9 / 8 * 8, height);
  int samples = options.quick ? 16 : 64;
  std::vector<CyclesRender> renders = {{samples, 1, {}, 0}, {samples, 2, {}, 0}};
  fs::path script = fs::path(options.scenes) / "../cycles/render.py";
  render_by_cycles(script, matte, view, max_depth, threads, workspace.folder,
                   options.quick ? 120 : 900, renders);
  PicturePair theirs{renders[0].frame, renders[1].frame,
                     (renders[0].seconds + renders[1].seconds) / 2};
  double target = noise(theirs);

  World world(scene);
  Lights lights = make_lights(world);
  // Twice the samples until our noise is below theirs; the time between two steps by a power law.
  double before = 0, before_seconds = 0, seconds = 0;
  int spp = 4;
  PicturePair ours;
  for (;; spp *= 2) {
    ours = render_ours(world, lights, view, max_depth, spp, uint64_t(spp) * 2);
    double error = noise(ours);
    seconds = ours.seconds;
    if (error <= target && before > target)
      seconds = before_seconds * std::pow(seconds / before_seconds,
                                          std::log(before / target) / std::log(before / error));
    if (error <= target || spp >= 16 * samples) break;
    before = error;
    before_seconds = ours.seconds;
  }
  Agreement agreement = compare_pairs(ours, theirs);
  nlohmann::json fields = {{"scene", name},
                           {"size", std::to_string(view.width) + "x" + std::to_string(view.height)},
                           {"threads", threads},
                           {"rmse", target},
                           {"cycles_samples", samples},
                           {"cycles_seconds", theirs.seconds},
                           {"path_samples", spp},
                           {"path_seconds", seconds}};
  report.add("light.path.cycles_time_ratio", seconds / theirs.seconds, "1", fields);
  report.add("light.path.cycles_relative_mean", agreement.relative_mean, "1",
             {{"scene", name}, {"standard_error", agreement.relative_error}});
  report.add("light.path.cycles_block_z", agreement.block_z, "1", {{"scene", name}});
  report.add("light.path.cycles_block_correlation", agreement.correlation, "1",
             {{"scene", name}, {"standard_error", agreement.correlation_error}});
}

}  // namespace

void bench_light_cycles(BenchReport& report, const BenchOptions& options) {
  if (!has_blender()) {
    std::cout << "light.path.cycles_*: skipped, no blender on the PATH\n";
    return;
  }
  const std::pair<const char*, fs::path> scenes[] = {
      {"cornell_box", fs::path(options.scenes) / "cornell_box.glb"},
      {"castle", fs::path(options.content) / "castle/scene.glb"}};
  for (const auto& [name, file] : scenes) {
    try {
      bench_scene(report, options, name, file);
    } catch (const std::runtime_error& error) {  // no numpy, another Blender, no time
      std::cout << "light.path.cycles_*: " << name << " skipped: " << error.what() << "\n";
    }
  }
}

}  // namespace wellspring
