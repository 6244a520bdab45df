// SPDX-License-Identifier: Apache-2.0
// No ray slips between two triangles that share an edge: rays from inside closed meshes, aimed at
// edges as exactly as floats can say, whichever way they are asked. (Of a tree that is not
// watertight one in fifteen slips.) Corners are left out: where many triangles meet, signs that
// agree along each edge may still leave no triangle, and of rays aimed at a corner to the last
// digit one in some hundreds does slip; a random ray comes that near to one with a chance of about
// 1e-13 times the triangles.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/rng.h"
#include "scenes/scenes.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int rays_of_a_case = 64000;

// sphere_mesh with the seam's and the poles' vertices, which are nearly the same, made the same.
Mesh closed_ball(float radius, int rings) {
  Mesh ball = sphere_mesh(0, radius, rings);
  const size_t row = size_t(2 * rings) + 1;
  for (size_t y = 0; y <= size_t(rings); y++) {
    vec3* of_row = ball.positions.data() + y * row;
    of_row[row - 1] = of_row[0];
    if (y == 0 || y == size_t(rings)) std::fill(of_row, of_row + row, of_row[0]);
  }
  return ball;
}

struct Target {
  vec3 from, to;
};

// Aims from around the middle of a convex mesh towards places on its edges.
Target aim(const Mesh& mesh, const mat4& to_world, vec3 middle, float reach, Rng& random) {
  uvec3 triangle = mesh.triangles[random.next() % mesh.triangles.size()];
  uint32_t side = random.next() % 3;
  vec3 a = vec3(to_world * vec4(mesh.positions[triangle[int(side)]], 1));
  vec3 b = vec3(to_world * vec4(mesh.positions[triangle[int((side + 1) % 3)]], 1));
  float along = 0.01f + 0.98f * random.uniform();
  vec3 aside(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
  return {middle + reach * aside, a + along * (b - a)};
}

struct Slipped {
  int nearest = 0, among_others = 0, as_packet = 0, occluder = 0, occluder_packet = 0;
};

Slipped count_slipped(const World& world, const Mesh& mesh, const mat4& to_world, vec3 middle,
                      float reach, uint64_t seed) {
  Rng random(seed);
  Slipped slipped;
  constexpr int width = RayPacket::lanes;
  constexpr uint32_t all = (1u << width) - 1;
  for (int n = 0; n < rays_of_a_case; n += width) {
    Ray rays[width];
    RayPacket packet{};
    for (int i = 0; i < width; i++) {
      Target target = aim(mesh, to_world, middle, reach, random);
      rays[i].origin = target.from;
      rays[i].direction = normalize(target.to - target.from);
      packet.origin_x[i] = rays[i].origin.x, packet.origin_y[i] = rays[i].origin.y;
      packet.origin_z[i] = rays[i].origin.z;
      packet.direction_x[i] = rays[i].direction.x, packet.direction_y[i] = rays[i].direction.y;
      packet.direction_z[i] = rays[i].direction.z;
      packet.t_max[i] = rays[i].t_max;
    }
    Hit each[width], many[width];
    world.intersect_each(packet, all, each);
    world.intersect_many(rays, many, width);
    uint32_t blocked = world.occluded_each(packet, all),
             blocked_packet = world.occluded_packet(packet, all);
    for (int i = 0; i < width; i++) {
      slipped.nearest += !world.intersect(rays[i]).valid();
      slipped.among_others += !each[i].valid();
      slipped.as_packet += !many[i].valid();
      slipped.occluder += !world.occluded(rays[i]) || !(blocked >> i & 1);
      slipped.occluder_packet += !(blocked_packet >> i & 1);
    }
  }
  return slipped;
}

void expect_tight(const World& world, const Mesh& mesh, const mat4& to_world, vec3 middle,
                  float reach, const std::string& what) {
  Slipped slipped = count_slipped(world, mesh, to_world, middle, reach, 7);
  EXPECT_EQ(slipped.nearest, 0) << what;
  EXPECT_EQ(slipped.among_others, 0) << what;
  EXPECT_EQ(slipped.as_packet, 0) << what;
  EXPECT_EQ(slipped.occluder, 0) << what;
  EXPECT_EQ(slipped.occluder_packet, 0) << what;
}

mat4 placed_at(vec3 place, float scale) {
  mat4 to_world(scale);
  to_world[3] = vec4(place, 1);
  return to_world;
}

TEST(Watertight, ClosedMeshesThatStandStill) {
  const std::pair<const char*, Mesh> shapes[] = {{"ball", closed_ball(1, 48)},
                                                 {"box", box_mesh(0, vec3(2), true)}};
  const std::pair<vec3, float> places[] = {{vec3(0), 1.0f},
                                           {vec3(3, -7, 11), 0.01f},
                                           {vec3(1000, 300, -2000), 1.0f},
                                           {vec3(0), 5000.0f}};
  for (const auto& [name, shape] : shapes)
    for (auto [place, scale] : places) {
      Scene scene = empty_scene();
      Mesh mesh = shape;
      mesh.material = add_material(scene, diffuse(vec3(0.5f)));
      add_mesh(scene, mesh, name);
      scene.instances.back().to_world = placed_at(place, scale);
      World world(scene);
      expect_tight(world, mesh, scene.instances.back().to_world, place, scale,
                   std::string(name) + ", scale " + std::to_string(scale));
    }
}

TEST(Watertight, ClosedMeshesThatMove) {
  Scene scene = empty_scene();
  Mesh ball = closed_ball(0.3f, 48);
  ball.material = add_material(scene, diffuse(vec3(0.5f)));
  scene.objects.push_back("ball");
  World world(scene, {ball}, {uint32_t(scene.objects.size()) - 1});
  for (vec3 by : {vec3(0), vec3(2, 1, -5), vec3(-70, 30, 20)}) {
    Mesh moved = ball;
    for (vec3& p : moved.positions) p += by;
    world.move(0, moved.positions, moved.normals);
    world.commit();
    expect_tight(world, moved, mat4(1), by, 0.3f, "moved by " + std::to_string(by.x));
  }
}

// A ray from afar to a place inside the outline passes the near side at an edge and must meet it,
// not the far side through it.
TEST(Watertight, NearSidesOfSolidsFromAfar) {
  Scene scene = empty_scene();
  Mesh ball = closed_ball(1, 48);
  ball.material = add_material(scene, diffuse(vec3(0.5f)));
  add_mesh(scene, ball, "ball");
  World world(scene);
  Rng random(11);
  int through = 0;
  for (int n = 0; n < rays_of_a_case; n++) {
    Target target = aim(ball, mat4(1), vec3(0), 0, random);
    vec3 aside(random.uniform() - 0.5f, random.uniform() - 0.5f, random.uniform() - 0.5f);
    Ray ray{.origin = 40.0f * normalize(target.to + 0.8f * aside)};
    vec3 line = target.to - ray.origin;
    ray.direction = normalize(line);
    if (dot(ray.direction, target.to) > -0.3f) continue;  // on the far side, or grazing
    Hit hit = world.intersect(ray);
    through += !hit.valid() || hit.t > length(line) + 0.1f;
  }
  EXPECT_EQ(through, 0);
}

}  // namespace
}  // namespace wellspring::test
