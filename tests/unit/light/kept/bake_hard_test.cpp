// SPDX-License-Identifier: Apache-2.0
// Scenes that are hard to bake.
#include <gtest/gtest.h>

#include <cmath>

#include "light/walk/known_light.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using test::Baked;

// Light on what a ray meets, as pictures read it; below 0: no map knows.
vec3 color_seen(const World& world, const IlluminationMap& map, vec3 from, vec3 towards) {
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  transport.maps = &map;
  Ray ray;
  ray.origin = from, ray.direction = normalize(towards - from);
  const Hit hit = world.intersect(ray);
  if (!hit.valid()) return vec3(-1);
  const KnownLight known = find_known_light(transport, ray, hit, eval_surface(world, ray, hit));
  return known.known ? known.light : vec3(-1);
}
float light_seen(const World& world, const IlluminationMap& map, vec3 from, vec3 towards) {
  return luminance(color_seen(world, map, from, towards));
}

PunctualLight add_sun(Scene& scene, vec3 direction) {
  PunctualLight sun;
  sun.type = PunctualType::directional;
  sun.direction = normalize(direction);
  sun.intensity = vec3(3);
  scene.lights.push_back(sun);
  return sun;
}

// Nodes on a column are as wide as a quarter of it; light falls on each place as its own normal
// faces.
TEST(BakeHard, ACurvedSurfaceIsLitByItsOwnNormals) {
  Scene scene = empty_scene();
  add_mesh(scene, test::tube_mesh(add_material(scene, diffuse(vec3(0.5f))), 0.3f, 1, 48), "column");
  const PunctualLight sun = add_sun(scene, vec3(-1, 0, -0.3f));
  Baked baked(scene, {.gather_nodes = 64, .direct_nodes = 64});
  auto map = baked.map(32);
  ASSERT_TRUE(map);
  double squares = 0, sum = 0;
  for (int i = 0; i < 256; i++) {
    const float phi = 2 * pi * (float(i) + 0.5f) / 256;
    const vec3 normal(std::cos(phi), 0, -std::sin(phi)), axis(0, 0.47f, 0);
    const double light = double(light_seen(baked.world, *map, axis + 2.0f * normal, axis));
    ASSERT_GE(light, 0) << i;
    const double truth = 3 * std::max(0.0, double(dot(normal, -sun.direction))) / double(pi);
    squares += (light - truth) * (light - truth), sum += truth;
  }
  EXPECT_LT(std::sqrt(squares / 256) / (sum / 256), 0.15);
}

// Folded paper: flat faces that share a chart, one towards the light, one away from it.
TEST(BakeHard, FlatFoldsAreLitEachByItsOwnNormal) {
  Scene scene = empty_scene();
  Mesh fold;
  fold.material = add_material(scene, diffuse(vec3(0.5f)));
  const int folds = 32;
  for (int i = 0; i < folds; i++) {
    const float x = 0.05f * float(i), z = i % 2 ? 0.01f : 0.0f, end = i % 2 ? 0.0f : 0.01f;
    const vec3 a(x, 0, z), b(x + 0.05f, 0, end), normal = normalize(vec3(z - end, 0, 0.05f));
    const uint32_t n = uint32_t(fold.positions.size());
    for (vec3 p : {a, b, b + vec3(0, 1, 0), a + vec3(0, 1, 0)}) {
      fold.positions.push_back(p), fold.normals.push_back(normal);
      fold.uv[0].push_back(vec2(0));
    }
    fold.triangles.push_back({n, n + 1, n + 2}), fold.triangles.push_back({n, n + 2, n + 3});
  }
  add_mesh(scene, fold, "fold");
  const PunctualLight sun = add_sun(scene, vec3(-0.5f, 0, -1));
  Baked baked(scene, {.gather_nodes = 200, .direct_nodes = 200});
  auto map = baked.map(16);
  ASSERT_TRUE(map);
  for (int i = 8; i < folds - 8; i++) {
    const vec3 place(0.05f * (float(i) + 0.5f), 0.5f, 0);
    const vec3 normal = normalize(vec3(i % 2 ? 0.01f : -0.01f, 0, 0.05f));
    const float truth = 3 * dot(normal, -sun.direction) / pi;
    EXPECT_NEAR(light_seen(baked.world, *map, place + vec3(0, 0, 1), place), truth, 0.06f * truth);
  }
}

Scene make_two_boxes(float scale) {
  Scene scene = empty_scene();
  const int white = add_material(scene, diffuse(vec3(0.6f)));
  const Mesh box = box_mesh(white, scale * vec3(1, 0.5f, 1));
  add_mesh(scene, box_mesh(white, scale * vec3(4, 0.1f, 4)), "floor", at({0, -0.05f * scale, 0}));
  add_mesh(scene, box, "box", at(scale * vec3(0.8f, 0.25f, 0)));
  scene.environment.radiance = vec3(1);
  return scene;
}

// Scenes are of millimetres, metres and kilometres.
TEST(BakeHard, LightDoesNotDependOnTheScale) {
  const BakeSettings few{.gather_nodes = 1500, .direct_nodes = 3000};
  Baked metres(make_two_boxes(1), few);
  auto expected = metres.map(16);
  ASSERT_TRUE(expected);
  for (float scale : {1e-3f, 1e3f}) {
    Baked baked(make_two_boxes(scale), few);
    auto map = baked.map(16);
    ASSERT_TRUE(map);
    EXPECT_NEAR(map->nodes.light.size() / double(expected->nodes.light.size()), 1, 0.1) << scale;
    EXPECT_NEAR(map->mean / expected->mean, 1, 0.02) << scale;
    for (vec3 place : {vec3(-1.2f, 0, 0.3f), vec3(0.2f, 0, 0.1f), vec3(0.8f, 0.5f, 0)}) {
      const vec3 eye = place + vec3(-0.3f, 1, 0.2f);
      const float there = light_seen(metres.world, *expected, eye, place);
      EXPECT_NEAR(light_seen(baked.world, *map, scale * eye, scale * place), there, 0.06f * there)
          << scale;
    }
  }
}

TEST(BakeHard, AThingSmallerThanATexelIsLit) {
  Scene scene = make_two_boxes(1);
  add_mesh(scene, box_mesh(scene.meshes[0].material, vec3(2e-3f)), "crumb", at({-1, 0.5f, 0}));
  Baked baked(scene, {.gather_nodes = 600, .direct_nodes = 800});
  auto map = baked.map(32);
  ASSERT_TRUE(map);
  const vec3 crumb(-1, 0.5f, 0);
  // Open sky above, half sky and half floor beside; that sends back less than the sky.
  EXPECT_NEAR(light_seen(baked.world, *map, crumb + vec3(0, 0.1f, 0), crumb), 1, 0.05);
  const float beside = light_seen(baked.world, *map, crumb + vec3(-0.1f, 0, 0), crumb);
  EXPECT_GT(beside, 0.6f);
  EXPECT_LT(beside, 1.0f);
}

TEST(BakeHard, InstancesOfOneMeshHaveTheirOwnLight) {
  Scene scene = empty_scene();
  const int white = add_material(scene, diffuse(vec3(0.6f)));
  add_mesh(scene, box_mesh(white, vec3(1)), "dark", at({5, 0, 0}));
  add_mesh(scene, box_mesh(white, vec3(3), true), "closed", at({5, 0, 0}));
  scene.environment.radiance = vec3(1);
  scene.instances.push_back(scene.instances[0]);
  scene.instances.back().to_world = at({-5, 0, 0}) * glm::scale(mat4(1), vec3(-1, 1, 1));
  Baked baked(scene, {.gather_nodes = 600, .direct_nodes = 800});
  auto map = baked.map(8);
  ASSERT_TRUE(map);
  EXPECT_NEAR(light_seen(baked.world, *map, {-5, 1, 0}, {-5, 0, 0}), 1, 0.1);
  EXPECT_LT(light_seen(baked.world, *map, {5, 1, 0}, {5, 0, 0}), 0.01f);
}

// Charts come of geometry: texture coordinates that lie on one another, or are not there, are none
// of their business.
TEST(BakeHard, TextureCoordinatesDoNotMatter) {
  const BakeSettings few{.gather_nodes = 300, .direct_nodes = 400};
  Scene bare = make_two_boxes(1), heaped = bare;
  for (Mesh& mesh : bare.meshes) mesh.uv[0].clear();
  for (Mesh& mesh : heaped.meshes) mesh.uv[0].assign(mesh.positions.size(), vec2(0.5f));
  Baked a(bare, few), b(heaped, few), c(make_two_boxes(1), few);
  const auto expected = c.map(2);
  EXPECT_EQ(a.map(2)->nodes.light, expected->nodes.light);
  EXPECT_EQ(b.map(2)->nodes.light, expected->nodes.light);
}

// Leaves over a floor: both sides of a sheet are lit, each by its own half of the room.
TEST(BakeHard, ALeafIsLitOnBothSides) {
  for (AlphaMode alpha : {AlphaMode::opaque, AlphaMode::mask, AlphaMode::blend}) {
    Scene scene = empty_scene();
    Material leaf = diffuse(vec3(0.5f));
    leaf.double_sided = true, leaf.alpha_mode = alpha;
    test::add_fan(scene, add_material(scene, leaf), {-0.5f, 1, 0.5f}, {1, 0, 0}, {0, 0, -1});
    test::add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {-2, 0, 2}, {4, 0, 0},
                  {0, 0, -4});
    scene.lights.push_back(test::point_light({0, 2, 0}, vec3(4)));
    Baked baked(scene, {.gather_nodes = 600, .direct_nodes = 2000});
    auto map = baked.map(16);
    ASSERT_TRUE(map);
    const vec3 middle(0.1f, 1, 0.1f);
    EXPECT_NEAR(light_seen(baked.world, *map, middle + vec3(0, 0.5f, 0), middle), 4 / pi, 0.12);
    const float below = light_seen(baked.world, *map, middle - vec3(0, 0.5f, 0), middle);
    EXPECT_GT(below, 0.01f);
    EXPECT_LT(below, 0.3f);
    EXPECT_LT(light_seen(baked.world, *map, {0.1f, 0.5f, 0.1f}, {0.1f, 0, 0.1f}), 0.1f);
  }
}

// A closed room of sheets in a closed room: the lamp of each lights its own side of them alone.
TEST(BakeHard, ARoomInsideARoomHasItsOwnLight) {
  Scene scene = empty_scene();
  Material sheet = diffuse(vec3(0.5f));
  sheet.double_sided = true;
  const int white = add_material(scene, sheet);
  for (float size : {4.0f, 1.0f}) add_mesh(scene, box_mesh(white, vec3(size)), "room");
  scene.lights.push_back(test::point_light({1.2f, 0.1f, 0.2f}, vec3(6, 0, 0)));
  scene.lights.push_back(test::point_light({0.1f, 0.1f, -0.1f}, vec3(0, 1, 0)));
  Baked baked(scene, {.gather_nodes = 1500, .direct_nodes = 3000});
  auto map = baked.map(16);
  ASSERT_TRUE(map);
  for (int axis = 0; axis < 3; axis++)
    for (float sign : {-1.0f, 1.0f})
      for (float aside : {-0.45f, 0.0f, 0.45f}) {  // edges, too
        vec3 way(0), wall(aside);
        way[axis] = sign, wall[axis] = 0.5f * sign;
        const vec3 inside = color_seen(baked.world, *map, wall - 0.1f * way, wall),
                   outside = color_seen(baked.world, *map, wall + 0.1f * way, wall),
                   around = color_seen(baked.world, *map, 1.9f * way, 2.0f * way);
        EXPECT_GT(inside.y, 0.1f);
        EXPECT_LT(inside.x, 1e-3f);
        EXPECT_GT(outside.x, 0.01f);
        EXPECT_LT(outside.y, 1e-3f);
        EXPECT_GT(around.x, 0.05f);
        EXPECT_LT(around.y, 1e-3f);
      }
}

// A hall of a million triangles takes as many nodes as were asked for.
TEST(BakeHard, AMillionTrianglesTakeNoMoreThanTheirNodes) {
  Scene scene = empty_scene();
  Mesh hills;
  hills.material = add_material(scene, diffuse(vec3(0.5f)));
  const uint32_t side = 708;
  for (uint32_t i = 0; i < side * side; i++) {
    const float x = float(i % side), z = float(i / side);
    hills.positions.push_back(0.02f * vec3(x, 3 * std::sin(0.11f * x) * std::cos(0.13f * z), z));
    hills.normals.push_back({0, 1, 0});
    if (i % side == 0 || i < side) continue;
    hills.triangles.push_back({i, i - side, i - side - 1});
    hills.triangles.push_back({i, i - side - 1, i - 1});
  }
  add_mesh(scene, hills, "hills");
  EXPECT_GT(scene.meshes[0].triangles.size(), 999000u);
  World world(scene);
  const BakeSettings settings{.gather_nodes = 20000, .direct_nodes = 60000};
  const Bake bake = begin_bake(world, {}, settings);
  EXPECT_GT(bake.gather.nodes(), 2000u);
  EXPECT_LE(bake.gather.nodes(), 20000u);
  EXPECT_LT(memory_bytes(bake), size_t(64) << 20);
}

}  // namespace
}  // namespace wellspring::test
