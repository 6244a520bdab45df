// SPDX-License-Identifier: Apache-2.0
// The mesh that rays meet in place of a scan is closed, and the eye looks through it.
#include "world/load/stand_in.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "scenes/build.h"
#include "unit/scan/made_nodes.h"
#include "world/raster/raster.h"
#include "world/surface.h"
#include "world/world.h"

namespace wellspring::test {
namespace {

using namespace scenes;

Scene floor_scene(bool has_normals) {
  const MadeNode node(2, 16, has_normals);
  Scene scene = empty_scene();
  Mesh mesh = make_stand_in(std::span(&node.points, 1));
  Material material = diffuse(vec3(1));
  material.double_sided = true;
  mesh.material = add_material(scene, material);
  add_mesh(scene, std::move(mesh), "scan");
  add_quad(scene, diffuse(vec3(0.5f)), {-9, -1, 9}, {18, 0, 0}, {0, 0, -18}, "ground");
  return scene;
}

TEST(StandIn, HasNoHolesWherePointsAreAtTheirSpacing) {
  const Scene scene = floor_scene(true);
  const World world(scene);
  Rng random(1);
  for (int i = 0; i < 2000; i++) {
    const vec3 from(1.9f * random.uniform() - 0.95f, 1, 1.9f * random.uniform() - 0.95f);
    const Hit hit = world.intersect({from, 0, {0, -1, 0}});
    ASSERT_TRUE(hit.valid());
    EXPECT_EQ(hit.instance, 0u) << from.x << ' ' << from.z;
    EXPECT_NEAR(hit.t, 1, 1e-4);
  }
}

TEST(StandIn, TheEyeDoesNotSeeIt) {
  const Scene scene = floor_scene(true);
  const World world(scene);
  Ray ray{{0.1f, 1, 0.1f}, 0, {0, -1, 0}};
  EXPECT_EQ(world.intersect(ray).instance, 0u);
  ray.from_eye = true;
  EXPECT_EQ(world.intersect(ray).instance, 1u);
  ray.t_max = 1.5f;
  EXPECT_TRUE(world.occluded(ray)) << "it throws shadows";
  Raster raster(world);
  const View view = make_view_towards(scene, {0, 2, 0.1}, {0, 0, 0}, {0, 0, -1}, 0.5f, 32, 32);
  raster.draw(view, {}, [&](const RasterRun& run) {
    for (int i = 0; i < run.count; i++) EXPECT_EQ(run.instance[i], 1u);
  });
}

TEST(StandIn, RaysBeginBeyondSquaresThatLieAcross) {
  const Scene scene = floor_scene(true);
  const World world(scene);
  const Ray down{{0.1f, 1, 0.1f}, 0, {0, -1, 0}};
  const Hit hit = world.intersect(down);
  const Surface surface = eval_surface(world, down, hit);
  const vec3 off = offset_origin(surface, {0, 1, 0}) - surface.position;
  const float side = 2 * 0.9f * 2 / 16;
  EXPECT_NEAR(off.y, 0.25f * side, 1e-4f);
  EXPECT_EQ(off.x, 0);
}

TEST(StandIn, WithoutANormalItIsMetFromAllSides) {
  const Scene scene = floor_scene(false);
  const World world(scene);
  for (const vec3 way : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, -1)})
    EXPECT_EQ(world.intersect({vec3(0.06f, 0.01f, 0.06f) - 3.0f * way, 0, way}).instance, 0u);
}

TEST(StandIn, SplatsBecomeRectanglesAcrossTheirThinnestAxis) {
  SplatSet splats;
  splats.place = {vec3(1, 2, 3), vec3(0), vec3(NAN)};
  splats.scale = {vec3(0.2f, 0.001f, 0.1f), vec3(1), vec3(1)};
  splats.turn.assign(3, quat(1, 0, 0, 0));
  splats.opacity = {0.9f, 0.1f, 1};
  splats.color.assign(3, vec3(1, 0.5f, 2));
  const Mesh mesh = make_stand_in(splats, 100);
  ASSERT_EQ(mesh.triangles.size(), 2u) << "clear ones and those that lie nowhere are left out";
  EXPECT_TRUE(mesh.stands_in);
  EXPECT_NEAR(std::abs(mesh.normals[0].y), 1, 1e-5);
  vec3 low(1e9f), high(-1e9f);
  for (const vec3& p : mesh.positions) low = min(low, p), high = max(high, p);
  EXPECT_NEAR(high.x - low.x, 2 * 1.5f * 0.2f, 1e-5);
  EXPECT_NEAR(high.z - low.z, 2 * 1.5f * 0.1f, 1e-5);
  EXPECT_EQ(mesh.colors[0].z, 1);
}

TEST(StandIn, OfNothingIsEmpty) {
  EXPECT_TRUE(make_stand_in(std::span<const NodePoints>()).triangles.empty());
  EXPECT_TRUE(make_stand_in(SplatSet(), 10).triangles.empty());
}

}  // namespace
}  // namespace wellspring::test
