// SPDX-License-Identifier: Apache-2.0
// A figure is repainted: its points are forgotten, and only its.
#include <gtest/gtest.h>

#include "cache/cache.h"
#include "cache/packing.h"
#include "cache/point_cache.h"
#include "light/sample.h"
#include "unit/cache/room.h"

namespace wellspring::test {
namespace {

// Two squares that may move before a wall; each is as bright as its colour.
struct Wall {
  Scene scene;
  std::vector<Mesh> moving;
  Wall() {
    scene.objects = {"", "wall", "figure"};
    Material painted{
        .base_color = vec4(0.2f, 0.2f, 0.2f, 1), .metallic = 0, .specular = 0, .repaints = true};
    scene.materials = {painted, painted, painted};
    auto square = [](vec3 low, float size, int material) {
      Mesh mesh{.positions = {low, low + vec3(size, 0, 0), low + vec3(size, size, 0),
                              low + vec3(0, size, 0)}};
      mesh.normals.assign(4, vec3(0, 0, 1));
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
      mesh.material = material;
      return mesh;
    };
    moving = {square({-1.1f, -0.4f, 0}, 0.8f, 0), square({0.3f, -0.4f, 0}, 0.8f, 1)};
    scene.meshes = {square({-8, -8, -0.5f}, 16, 2)};
    scene.instances = {{0, mat4(1), 1}};
  }
};

TEST(Repaint, PointsOfTheRepaintedInstancesTakeTheirReflectance) {
  Wall wall;
  World world(wall.scene, wall.moving, {2, 2});
  PointCache points;
  resize_points(points, 8);
  for (uint32_t i = 0; i < 8; i++) {
    points.flags[i] = uint8_t(point_used | point_moving);
    points.age[i] = 3, points.count[i] = 20;
    points.normal[i] = pack_normal(vec3(0, 0, 1));
    points.color[i].albedo = pack_albedo(vec3(0.2f));
    points.anchors.push_back({i, 1 + i % 2, 0, 20000, 20000});
  }
  points.age[5] = evicted_age;
  world.repaint(1, {vec4(0.6f, 0, 0, 0), vec3(0, 3, 0), mat3(0.0f)});
  EXPECT_TRUE(invalidate_paint(points, world, {0, 0, 1}));
  for (uint32_t i = 0; i < 8; i++) {
    bool forgotten = i % 2 == 1 && i != 5;
    EXPECT_EQ(points.age[i], forgotten ? 254 : i == 5 ? evicted_age : 3) << i;
    EXPECT_EQ(points.count[i], forgotten ? 0 : 20) << i;
    EXPECT_EQ(bool(points.flags[i] & point_relit), forgotten) << i;
    EXPECT_NEAR(unpack_albedo(points.color[i].albedo).x, forgotten ? 0.8f : 0.2f, 0.01f) << i;
    EXPECT_NEAR(unpack_albedo(points.color[i].albedo).y, 0.2f, 0.01f) << i;
  }
  EXPECT_FALSE(invalidate_paint(points, world, {}));
}

// The left square becomes brighter: the World says so, or (`told` false) samples alone do. Shares
// of the pixels of either square that look as they should, after each of 20 pictures.
struct Shares {
  std::vector<float> left, right;
};
Shares brighten(bool told) {
  constexpr int width = 120, height = 80, pixels = width * height;
  Wall wall;
  World world(wall.scene, wall.moving, {2, 2});
  View view = look_at(vec3(0, 0, 3), vec3(0), 60, width, height);
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;
  float untold = 0;
  auto step = [&](int budget) {
    cache.resize(width, height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    samples.clear();
    for (const Request& request : requests) {
      Hit hit = world.intersect(request.ray);
      bool moves = world.is_moving(hit.instance);
      Sample sample{.position = request.ray.origin + hit.t * request.ray.direction,
                    .normal = vec3(0, 0, 1),
                    .distance = hit.t,
                    .object = world.object_of(hit.instance),
                    .instance = hit.instance,
                    .triangle = hit.triangle,
                    .barycentric = hit.barycentric,
                    .albedo = vec3(world.material_of(hit.instance).base_color) +
                              (hit.instance == 1 ? untold : 0),
                    .smooth = vec3(1),
                    .flags = uint8_t(sample_hit | (moves ? sample_moving : 0))};
      samples.push_back(sample);
    }
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame);
  };
  auto shown = [&](uint32_t instance, float wanted) {
    int like = 0, all = 0;
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++) {
        // Inside: reconstruct() smooths across edges.
        bool inside = true;
        for (vec2 to : {vec2(-1), vec2(2, -1), vec2(-1, 2), vec2(2)})
          inside &= world.intersect(view_ray(view, float(x) + to.x, float(y) + to.y)).instance ==
                    instance;
        if (!inside) continue;
        all++;
        like += std::abs(frame.color[size_t(y * width + x)].x - wanted) < 0.05f;
      }
    return float(like) / float(all);
  };
  for (int i = 0; i < 60; i++) step(pixels / 4);
  EXPECT_GT(shown(1, 0.2f), 0.99f);
  if (told) world.repaint(0, {vec4(0.6f, 0.6f, 0.6f, 0), vec3(0), mat3(0.0f)});
  else untold = 0.6f;
  Shares shares;
  for (int i = 0; i < 20; i++) {
    step(pixels / 32);
    shares.left.push_back(shown(1, 0.8f));
    shares.right.push_back(shown(2, 0.2f));
  }
  return shares;
}

// One pixel in 32 is asked for a picture; the colour is right in the first all the same.
TEST(Repaint, TheNextPictureShowsIt) {
  Shares told = brighten(true), untold = brighten(false);
  EXPECT_GT(told.left.front(), 0.9f);
  EXPECT_GT(told.left.back(), 0.95f);
  EXPECT_LT(untold.left.front(), 0.1f) << "else that would be no feat";
  EXPECT_LT(untold.left.back(), 0.7f);
  for (float share : told.right) EXPECT_GT(share, 0.99f) << "the other square is as it was";
}

}  // namespace
}  // namespace wellspring::test
