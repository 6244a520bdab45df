// SPDX-License-Identifier: Apache-2.0
#include "world/motion/scene_motion.h"

#include <algorithm>
#include <cmath>

#include "gltf/animation.h"
#include "unit/world/load/asset.h"
#include "world/load/scene_join.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;

SceneLoadOptions moving_options() { return SceneLoadOptions{.motion = true}; }

std::vector<double> only(const SceneMotion& motion, size_t clip, double time) {
  std::vector<double> times(motion.clips.size(), -1);
  times[clip] = time;
  return times;
}

struct Posed {
  std::vector<vec3> positions, normals;
};
Posed pose(const Scene& scene, size_t mover, size_t clip, double time) {
  const PlacedMotion& placed = scene.motions.front();
  ScenePose at;
  pose_motion(*placed.of, only(*placed.of, clip, time), at);
  Posed posed;
  pose_mover(at, placed.of->movers[mover],
             glm::translate(dmat4(1), -scene.origin) * placed.to_world, posed.positions,
             posed.normals);
  return posed;
}

// A triangle on a node that a clip turns by 90 degrees about +Y within a second, below a parent
// that stands at `parent`.
struct Turned {
  TempFolder folder;
  Asset asset;
  explicit Turned(const json& node = json::object(), const json& parent = json::object()) {
    const int mesh = asset.add_mesh(
        {{"attributes", {{"POSITION", asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0})}}}});
    json child = {{"mesh", mesh}, {"name", "door"}};
    child.update(node);
    asset.root["nodes"] = {child, {{"children", {0}}}};
    asset.root["nodes"][1].update(parent);
    asset.root["scenes"] = {{{"nodes", {1}}}};
    asset.root["scene"] = 0;
    const float half = std::sqrt(0.5f);
    add_clip("turn", "rotation", {0, 1}, "VEC4", 4, {0, 0, 0, 1, 0, half, 0, half});
  }
  void add_clip(const std::string& name, const std::string& path, const std::vector<float>& times,
                const char* type, int width, const std::vector<float>& values) {
    const int in = asset.add_floats("SCALAR", 1, times);
    const int out = asset.add_floats(type, width, values);
    asset.root["animations"].push_back(
        {{"name", name},
         {"samplers", {{{"input", in}, {"output", out}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  }
  Scene load() { return load_scene(folder.write("a.gltf", asset.gltf()), moving_options()); }
};

TEST(SceneMotion, MovesWhatHangsOnANodeWithItsNormals) {
  Turned file(json::object(), json{{"translation", {5, 0, 0}}});
  Scene scene = file.load();
  ASSERT_EQ(scene.motions.size(), 1u);
  ASSERT_EQ(scene.motions[0].of->movers.size(), 1u);
  EXPECT_EQ(scene.motions[0].of->clips[0].name, "turn");
  EXPECT_EQ(scene.motions[0].instances, std::vector<int>{0});
  Posed rest = pose(scene, 0, 0, 0), end = pose(scene, 0, 0, 1), later = pose(scene, 0, 0, 9);
  expect_near(rest.positions[1], {6, 0, 0});
  expect_near(rest.normals[1], {0, 0, 1});
  expect_near(end.positions[1], {5, 0, -1});
  expect_near(end.normals[1], {1, 0, 0});
  EXPECT_EQ(end.positions, later.positions) << "after its last key it holds still";
  const Posed half = pose(scene, 0, 0, 0.5);
  expect_near(half.positions[1], {5 + std::sqrt(0.5f), 0, -std::sqrt(0.5f)});
}

TEST(SceneMotion, IsKeptOnlyWhereItIsAskedForAndMovesSomething) {
  Turned file;
  const std::string path = file.folder.write("b.gltf", file.asset.gltf());
  EXPECT_TRUE(load_scene(path).motions.empty());
  file.asset.root["nodes"].push_back({{"name", "nothing"}});
  file.asset.root["animations"][0]["channels"][0]["target"]["node"] = 2;
  EXPECT_TRUE(file.load().motions.empty());
}

TEST(SceneMotion, StaysRightWhereTheSceneIsPlacedJoinedAndFarAway) {
  Turned file;
  Scene scene = file.load(), other = file.load();
  place_scene(other, {.position = {2e6, 0, 0}, .yaw = double(pi) / 2, .scale = 3});
  ASSERT_NE(other.origin.x, 0);
  const Posed far = pose(other, 0, 0, 0);
  expect_near(far.positions[1] + vec3(other.origin - dvec3(2e6, 0, 0)), {0, 0, -3});
  const size_t instances = scene.instances.size();
  join_scene(scene, file.load());
  ASSERT_EQ(scene.motions.size(), 2u);
  EXPECT_EQ(scene.motions[1].instances[0], int(instances));
}

TEST(SceneMotion, ANodeThatMirrorsKeepsItsNormalsOutside) {
  Turned file(json{{"scale", {-1, 1, 1}}}, json::object());
  Scene scene = file.load();
  const Posed rest = pose(scene, 0, 0, 0);
  expect_near(rest.positions[1], {-1, 0, 0});
  expect_near(rest.normals[1], {0, 0, 1});
}

TEST(SceneMotion, MorphTargetsAreAddedByTheirWeights) {
  Turned file;
  json& primitive = file.asset.root["meshes"][0]["primitives"][0];
  primitive["targets"] = {
      {{"POSITION", file.asset.add_floats("VEC3", 3, {0, 0, 0, 0, 0, 2, 0, 0, 0})}}};
  file.add_clip("bend", "weights", {0, 2}, "SCALAR", 1, {0, 1});
  Scene scene = file.load();
  const Posed half = pose(scene, 0, 1, 1);
  expect_near(half.positions[1], {1, 0, 1});
  expect_near(half.normals[0], normalize(vec3(-1, 0, 1)));  // the file has none: its faces'
  expect_near(pose(scene, 0, 0, 0).positions[1], {1, 0, 0});
}

TEST(SceneMotion, FineMeshesOfTheSameShape) {
  Turned file;
  Scene scene = file.load();
  Mover mover = scene.motions[0].of->movers[0];
  subdivide(mover, 1, 0.3, 10000);
  double area = 0, longest = 0;
  for (const uvec3& t : mover.mesh.triangles) {
    const vec3 a = mover.mesh.positions[t.x], b = mover.mesh.positions[t.y],
               c = mover.mesh.positions[t.z];
    area += 0.5 * double(glm::length(cross(b - a, c - a)));
    longest = std::max({longest, double(glm::length(b - a)), double(glm::length(c - b)),
                        double(glm::length(a - c))});
  }
  EXPECT_NEAR(area, 0.5, 1e-6);
  EXPECT_LE(longest, 0.3);
  EXPECT_GT(mover.mesh.triangles.size(), 8u);
  Mover coarse = scene.motions[0].of->movers[0];
  subdivide(coarse, 1, 1e-6, 100);
  EXPECT_LE(coarse.mesh.triangles.size(), 100u);
}

// Each moment as the loader itself makes it of the whole file.
TEST(SceneMotion, RealFilesMoveAsTheyDoWhenTheyAreLoadedAtThatTime) {
  const fs::path data = fs::path(WELLSPRING_DATA) / "1_gltf";
  if (!fs::exists(data)) GTEST_SKIP() << "no corpus at " << data;
  int compared = 0;
  std::string missing;
  for (const char* name :
       {"khronos/BoxAnimated/glTF-Binary/BoxAnimated.glb",
        "khronos/CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb",
        "khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb",
        "khronos/RiggedSimple/glTF/RiggedSimple.gltf",
        "khronos/BrainStem/glTF-Binary/BrainStem.glb",
        "khronos/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf",
        "khronos/AnimatedMorphSphere/glTF-Binary/AnimatedMorphSphere.glb",
        "khronos/AnimatedTriangle/glTF/AnimatedTriangle.gltf", "ozz/interpolation_test.gltf"}) {
    SCOPED_TRACE(name);
    const std::string path = (data / name).string();
    if (!fs::exists(path)) {
      missing += std::string(" ") + name;
      continue;
    }
    const Scene rest = load_scene(path, moving_options());
    ASSERT_FALSE(rest.motions.empty());
    const double end = gltf::length_of(rest.motions[0].of->clips[0]);
    for (double time : {0.13 * end, 0.5 * end, 0.91 * end}) {
      SceneLoadOptions options{.time = time};
      const Scene whole = load_scene(path, options);
      ASSERT_EQ(whole.instances.size(), rest.instances.size());
      for (size_t m = 0; m < rest.motions[0].of->movers.size(); m++) {
        const Instance& instance = whole.instances[size_t(rest.motions[0].instances[m])];
        const Mesh& mesh = whole.meshes[size_t(instance.mesh)];
        const Posed posed = pose(rest, m, 0, time);
        ASSERT_EQ(posed.positions.size(), mesh.positions.size());
        float size = 0, wrong = 0;
        for (size_t v = 0; v < mesh.positions.size(); v++) {
          const vec3 p = vec3(instance.to_world * vec4(mesh.positions[v], 1)) +
                         vec3(whole.origin - rest.origin);
          size = std::max(size, glm::length(p));
          wrong = std::max(wrong, glm::length(p - posed.positions[v]));
        }
        EXPECT_LT(wrong, 1e-4f * size);
        compared++;
      }
    }
  }
  EXPECT_GT(compared, 20);
  if (!missing.empty()) GTEST_SKIP() << "not all files are here:" << missing;
}

}  // namespace
}  // namespace wellspring::test
