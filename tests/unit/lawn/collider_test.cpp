// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "base/rng.h"
#include "made.h"

namespace wellspring::test {
namespace {

vec3 random_place(Rng& random, float reach) {
  return reach * (2.0f * vec3(random.uniform(), random.uniform(), random.uniform()) - 1.0f);
}

TEST(DepthCube, SphereMeasuresAsItsFormulaAlongAxes) {
  const float radius = 0.4f;
  const MadeMesh mesh = made_sphere(radius);
  const DepthCube cube(mesh.places, mesh.triangles, 129);
  for (int axis = 0; axis < 3; axis++)
    for (const float out : {-1.0f, 1.0f})
      for (float way = 0.05f; way < 1; way += 0.05f) {
        vec3 v{0};
        v[axis] = out * way;
        EXPECT_NEAR(cube.at(v).distance, way - radius, 2e-4f) << axis << ' ' << out * way;
      }
}

TEST(DepthCube, SignAgreesWithTheFormulaOffABand) {
  const float radius = 0.4f, texel = 2 * radius / 64;
  const MadeMesh mesh = made_sphere(radius);
  const DepthCube cube(mesh.places, mesh.triangles, 64);
  Rng random(5);
  int inside = 0;
  for (int i = 0; i < 20000; i++) {
    const vec3 v = random_place(random, 0.6f);
    const float exact = glm::length(v) - radius;
    if (std::abs(exact) < texel) continue;
    EXPECT_EQ(cube.at(v).distance < 0, exact < 0) << v.x << ' ' << v.y << ' ' << v.z;
    inside += exact < 0;
  }
  EXPECT_GT(inside, 2000);
}

TEST(DepthCube, NormalsPointOutWhicheverWayTrianglesTurn) {
  MadeMesh mesh = made_sphere(0.3f, 32);
  for (size_t i = 0; i < mesh.triangles.size(); i += 2)
    std::swap(mesh.triangles[i].x, mesh.triangles[i].y);
  const DepthCube cube(mesh.places, mesh.triangles);
  Rng random(2);
  for (int i = 0; i < 1000; i++) {
    const vec3 v = random_place(random, 0.16f);
    const DepthCube::Depth depth = cube.at(v);
    ASSERT_LT(depth.distance, 0);
    EXPECT_GT(dot(depth.normal, depth.axis), 0.3f);
    EXPECT_NEAR(glm::length(depth.normal), 1, 1e-4f);
  }
}

TEST(DepthCube, WithoutAUsableTriangleNothingIsInside) {
  const std::vector<vec3> places = {{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}};
  const std::vector<uvec3> bad = {{0, 1, 2}, {0, 1, 9}, {0, 1, 1}, {0, 0, 0}};
  for (const int side : {-3, 1, 64})
    EXPECT_EQ(DepthCube(places, bad, side).at(vec3(0)).distance, INFINITY);
  EXPECT_EQ(DepthCube({}, {}).at(vec3(NAN)).distance, INFINITY);
}

std::vector<PlacedCube> turned_ell(const DepthCube& cube) {
  const mat3 turn(glm::rotate(mat4(1), 0.7f, normalize(vec3(1, 2, -0.5f))));
  return {{&cube, {0.3f, -0.2f, 5}, turn}};
}

TEST(Push, EveryPlaceInsideIsOutsideAfterwards) {
  MadeMesh ell;
  add_box(ell, {-0.4f, -0.2f, -0.2f}, {0.4f, 0.2f, 0.2f});
  add_box(ell, {0.2f, -0.2f, -0.2f}, {0.4f, 0.7f, 0.2f});
  const DepthCube cube(ell.places, ell.triangles);
  const Walkers walkers = {
      {{{0.1f, 0.2f, 5}, {0.4f, 0.2f, 5.2f}, 0.5f}, {{0, 0, 5}, {0, 0, 5}, 0.3f}},
      turned_ell(cube)};
  const std::vector<Collider> colliders = find_colliders(walkers);
  ASSERT_EQ(colliders.size(), 3u);
  Rng random(8);
  for (const Collider& collider : colliders) {
    int inside = 0;
    for (int i = 0; i < 2000; i++) {
      Lanes3 v;
      for (int lane = 0; lane < lane_count; lane++)
        v.set(lane, vec3(0.2f, 0, 5) + random_place(random, 0.9f));
      const Lanes3 before = v;
      const unsigned lanes = random.next() & 0xff,
                     moved = negative_lanes(push_out(collider, lanes_of_bits(lanes), v));
      for (int lane = 0; lane < lane_count; lane++) {
        const float distance = distance_to(collider, before.at(lane));
        const bool asked = lanes >> lane & 1;
        EXPECT_EQ(bool(moved >> lane & 1), asked && distance < 0);
        if (moved >> lane & 1) {
          EXPECT_GE(distance_to(collider, v.at(lane)), 0);
          inside++;
        } else {
          EXPECT_EQ(v.at(lane), before.at(lane));
        }
      }
    }
    EXPECT_GT(inside, 100);
  }
}

TEST(Push, PlaceOnTheLineOfACapsuleLeavesIt) {
  for (const vec3 end : {vec3(0), vec3(0, 1, 0), vec3(1, 0, 0), vec3(0.3f, 0.2f, 1)}) {
    const Walkers walkers = {{{vec3(0), end, 0.25f}}, {}};
    const Collider collider = find_colliders(walkers)[0];
    Lanes3 v = all_lanes(0.5f * end);
    push_out(collider, LaneMask{} - 1, v);
    EXPECT_GE(distance_to(collider, v.at(3)), 0);
    EXPECT_TRUE(is_finite(v.at(3)));
  }
}

TEST(Colliders, UnusableWalkersAreLeftOut) {
  const MadeMesh mesh = made_sphere(1, 8);
  const DepthCube cube(mesh.places, mesh.triangles), empty({}, {});
  Walkers walkers;
  walkers.capsules = {{vec3(NAN), vec3(0), 1},  {vec3(0), vec3(INFINITY), 1},
                      {vec3(0), vec3(1), NAN},  {vec3(0), vec3(1), INFINITY},
                      {vec3(0), vec3(1), 0},    {vec3(0), vec3(1), -1},
                      {vec3(1e9f), vec3(1), 1}, {vec3(0), vec3(1), 0.1f}};
  walkers.cubes = {{nullptr},
                   {&empty},
                   {&cube, vec3(NAN)},
                   {&cube, vec3(0), mat3(2)},
                   {&cube, vec3(0), mat3(NAN)},
                   {&cube}};
  EXPECT_EQ(find_colliders(walkers).size(), 2u);
}

}  // namespace
}  // namespace wellspring::test
