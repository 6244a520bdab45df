// SPDX-License-Identifier: Apache-2.0
#include "light_scenes.h"

#include <filesystem>

#include "base/load_error.h"
#include "show/exhibit/load/exhibit_load.h"
#include "world/load/scene_load.h"

namespace wellspring::test {
namespace {

struct Entry {
  const char *name, *about;
  int max_depth;
};
// Depths at which one edge more changes the picture by less than the reference's own noise.
const Entry entries[] = {
    {"castle", "an exhibit: textures, 294 lamps, windows, panes", 8},
    {"cornell_box", "purely diffuse, one lamp", 8},
    {"diffuse_hall", "daylight from one side, mostly light between walls", 8},
    {"caustics", "glass, metal and a small lamp", 12},
    {"conference", "104 lamps, gloss and metal", 8},
};

BenchScene load(const BenchOptions& options, const Entry& entry) {
  BenchScene bench{entry.name, entry.about, {}, {}, entry.max_depth};
  if (bench.name == "castle") {
    Exhibit castle = load_exhibit((std::filesystem::path(options.content) / "castle").string());
    bench.camera = castle.viewpoints[size_t(castle.start)].view;
    bench.scene = std::move(castle.scene);
    return bench;
  }
  std::string file = (std::filesystem::path(options.scenes) / (bench.name + ".glb")).string();
  bench.scene = load_scene(file);
  if (bench.scene.viewpoints.empty()) throw LoadError(file, "/cameras", "has no camera");
  bench.camera = bench.scene.viewpoints[0];
  return bench;
}

}  // namespace

std::vector<BenchScene> load_bench_scenes(const BenchOptions& options) {
  std::vector<BenchScene> scenes;
  for (const Entry& entry : entries) scenes.push_back(load(options, entry));
  return scenes;
}

BenchScene load_bench_scene(const BenchOptions& options, const std::string& name) {
  for (const Entry& entry : entries)
    if (name == entry.name) return load(options, entry);
  throw LoadError(name, "", "is none of the benchmark's scenes");
}

View bench_view(const BenchScene& bench, int width, int height) {
  const Viewpoint& c = bench.camera;
  return make_view(bench.scene, c.position, c.yaw, c.pitch, c.fov, width, height);
}

}  // namespace wellspring::test
