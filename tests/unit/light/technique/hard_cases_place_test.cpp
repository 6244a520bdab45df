// SPDX-License-Identifier: Apache-2.0
// Where a scene lies and how big it is does not matter; nor how finely or badly it is triangulated.
// Whole pictures of every technique, judged pixel group by pixel group.
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "unit/light/judge.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"
#include "world/load/scene_load.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

using nlohmann::json;

// The benchmark's Cornell box under one more node that scales and moves all of it.
Scene load_moved_box(double scale, dvec3 place) {
  namespace fs = std::filesystem;
  std::ifstream in(fs::path(WELLSPRING_SOURCE) / "tests/benchmark/scenes/cornell_box.glb",
                   std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  uint32_t head[5];
  std::memcpy(head, bytes.data(), sizeof head);
  json gltf = json::parse(bytes.substr(20, head[3]));
  json root = {{"children", gltf["scenes"][0]["nodes"]},
               {"scale", {scale, scale, scale}},
               {"translation", {place.x, place.y, place.z}}};
  gltf["scenes"][0]["nodes"] = {gltf["nodes"].size()};
  gltf["nodes"].push_back(root);
  std::string text = gltf.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string rest = bytes.substr(20 + head[3]);
  head[2] = uint32_t(20 + text.size() + rest.size());
  head[3] = uint32_t(text.size());
  fs::path file =
      fs::temp_directory_path() / ("wellspring_box_" + std::to_string(getpid()) + ".glb");
  std::ofstream(file, std::ios::binary)
      << std::string(reinterpret_cast<const char*>(head), 20) << text << rest;
  Scene scene = load_scene(file.string());
  fs::remove(file);
  return scene;
}

View view_of(const Scene& scene, int size) {
  const Viewpoint& v = scene.viewpoints.at(0);
  return make_view(scene, v.position, v.yaw, v.pitch, v.fov, size, size);
}

// Estimates of the picture's tiles, `across` each way.
std::vector<Estimate> estimate_tiles(const Technique& technique, const Scene& scene,
                                     const View& view, int across, int spp, uint64_t seed) {
  World world(scene);
  Lights lights = make_lights(world);
  constexpr int replicates = 16;
  int tiles = across * across, side = view.width / across;
  std::vector<std::vector<double>> sums(size_t(tiles), std::vector<double>(replicates, 0));
  parallel_for(replicates, [&](int r) {
    StillSettings settings;
    settings.spp = spp;
    settings.seed = mix64(seed + uint64_t(r));
    settings.transport.max_depth = 4;
    Frame frame = render_still(technique, world, lights, view, settings);
    for (int y = 0; y < view.height; y++)
      for (int x = 0; x < view.width; x++)
        sums[size_t(y / side * across + x / side)][size_t(r)] +=
            double(luminance(frame.color[size_t(y * view.width + x)]));
  });
  EXPECT_EQ(lights.bad_samples->load(), 0u) << technique.name;
  std::vector<Estimate> estimates;
  for (const std::vector<double>& s : sums) estimates.push_back(make_estimate(s));
  return estimates;
}

// Techniques that prepare themselves keep light with an error of its own, which no replicate shows;
// they are asked for finite pictures elsewhere.
void expect_same_pictures(const Scene& a, const View& view_a, const Scene& b, const View& view_b,
                          const std::string& what) {
  Family family;
  for (const Technique& technique : techniques()) {
    if (technique.prepare) continue;
    auto ours = estimate_tiles(technique, a, view_a, 6, 16, 1),
         theirs = estimate_tiles(technique, b, view_b, 6, 16, 1001);
    for (size_t i = 0; i < ours.size(); i++)
      if (ours[i].mean > 0 || theirs[i].mean > 0)
        family.add_same(std::string(technique.name) + ", " + what + ", tile " + std::to_string(i),
                        ours[i], theirs[i]);
  }
  expect_family(family, 0.6);  // a rough check of each tile, the dark and noisy ones too
}

}  // namespace

TEST(HardCases, MovedAThousandKilometres) {
  Scene here = load_moved_box(1, {0, 0, 0}), there = load_moved_box(1, {1e6, -1e6, 1e6});
  EXPECT_GT(length(there.origin), 1e6);
  expect_same_pictures(here, view_of(here, 24), there, view_of(there, 24), "moved");
}

TEST(HardCases, AThousandTimesSmaller) {
  Scene here = load_moved_box(1, {0, 0, 0}), small = load_moved_box(1e-3, {0, 0, 0});
  expect_same_pictures(here, view_of(here, 24), small, view_of(small, 24), "small");
}

TEST(HardCases, AThousandTimesLarger) {
  Scene here = load_moved_box(1, {0, 0, 0}), large = load_moved_box(1e3, {0, 0, 0});
  expect_same_pictures(here, view_of(here, 24), large, view_of(large, 24), "large");
}

TEST(HardCases, SmallAndFarAway) {
  Scene here = load_moved_box(1, {0, 0, 0}), there = load_moved_box(1e-3, {1e6, 1e6, -1e6});
  expect_same_pictures(here, view_of(here, 24), there, view_of(there, 24), "small and far away");
}

// Every wall cut into slivers thinner than a hair, with triangles of no area between them.
TEST(HardCases, WallsOfSlivers) {
  Scene whole = make_cornell_box(), cut = make_cornell_box();
  for (Mesh& mesh : cut.meshes) {
    if (mesh.triangles.size() != 2) continue;
    vec3 a = mesh.positions[0], u = mesh.positions[1] - a, v = mesh.positions[3] - a;
    Mesh slivers;
    slivers.material = mesh.material;
    for (int i = 0; i < 40; i++) {
      float t0 = float(i) / 40, t1 = i % 2 ? float(i + 1) / 40 : t0 + 1e-6f, t2 = float(i + 1) / 40;
      append_quad(slivers, a + t0 * u, (t1 - t0) * u, v);
      if (t1 < t2) append_quad(slivers, a + t1 * u, (t2 - t1) * u, v);
      uint32_t last = uint32_t(slivers.positions.size()) - 1;
      slivers.triangles.push_back({last, last, last - 1});
    }
    for (vec3& n : slivers.normals) n = mesh.normals[0];
    mesh = slivers;
  }
  expect_same_pictures(whole, cornell_view(whole, 24, 24), cut, cornell_view(cut, 24, 24),
                       "slivers");
}

// A point light a tenth of a millimetre above the floor, and a sun two hundredths of a degree: by
// formula.
TEST(HardCases, GrazingLight) {
  Family family;
  PunctualLight low;
  low.position = {1, 1e-4f, 0};
  low.intensity = vec3(1000);
  PunctualLight sun;
  sun.type = PunctualType::directional;
  sun.direction = normalize(vec3(1, -3e-4f, 0));
  sun.intensity = vec3(1000);
  for (const auto& [light, expected] :
       {std::pair(low, 0.5 / double(pi) * 1000 * 1e-4 / std::pow(1 + 1e-8, 1.5)),
        std::pair(sun, 0.5 / double(pi) * 1000 * double(-sun.direction.y))}) {
    Scene scene = make_plane_with_punctual(light);
    World world(scene);
    Lights lights = make_lights(world);
    for (const Technique& technique : techniques())
      family.add(std::string(technique.name) + ", grazing",
                 estimate_radiance(technique, world, lights,
                                   view_along(ray_towards({0, 1, 0.5f}, {0, 0, 0}), technique), {},
                                   {16, 16, 1}),
                 expected);
  }
  expect_family(family);
}
