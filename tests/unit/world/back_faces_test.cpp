// SPDX-License-Identifier: Apache-2.0
// For the eye single-sided faces have no back (glTF 2.0 section 3.9.5); for light they have.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "scenes/build.h"
#include "world/raster/raster.h"
#include "world/surface.h"
#include "world/world.h"
#include "world/world_packet.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr uint32_t near_quad = 0, far_quad = 1;

// Two squares before an eye at (0, 0, 5) that looks down -Z: one at z = 1 that shows it its back,
// one at z = 0 that faces it.
Scene two_squares(const Material& near_material) {
  Scene scene = empty_scene();
  scene.cull_back_faces = true;
  const int near = add_material(scene, near_material), far = add_material(scene, diffuse(vec3(1)));
  add_quad(scene, near, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, "near");
  add_wall(scene, far, 0, 1, "far");
  return scene;
}

View eye(const Scene& scene) {
  return make_view_towards(scene, {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.3f, 32, 32);
}

Ray eye_ray(const Scene& scene) { return view_ray(eye(scene), 15.3f, 16.1f); }

uint32_t seen(const Scene& scene) {
  const World world(scene);
  return world.intersect(eye_ray(scene)).instance;
}

TEST(BackFaces, TheEyeLooksThroughThoseOfSingleSidedMaterialsOnly) {
  EXPECT_EQ(seen(two_squares(diffuse(vec3(1)))), far_quad);
  Material both = diffuse(vec3(1));
  both.double_sided = true;
  EXPECT_EQ(seen(two_squares(both)), near_quad);
  Scene shown = two_squares(diffuse(vec3(1)));
  shown.cull_back_faces = false;
  EXPECT_EQ(seen(shown), near_quad);
}

TEST(BackFaces, GlassThatEnclosesAMediumIsMetFromWithin) {
  Material solid = glass(1.5f, 0, 1), pane = glass(1.5f, 0, 0);
  solid.double_sided = pane.double_sided = false;
  EXPECT_EQ(seen(two_squares(solid)), near_quad);
  EXPECT_EQ(seen(two_squares(pane)), far_quad);
}

TEST(BackFaces, LightIsStoppedByBothSides) {
  const Scene scene = two_squares(diffuse(vec3(1)));
  const World world(scene);
  Ray ray = eye_ray(scene);
  ray.t_max = 4.5f;
  EXPECT_TRUE(world.occluded(ray));
  ray.from_eye = false;
  EXPECT_EQ(world.intersect(ray).instance, near_quad);
}

TEST(BackFaces, AFrontInTheSamePlaceIsSeen) {
  Scene scene = two_squares(diffuse(vec3(1)));
  const int front = add_wall(scene, 2, 1, 1, "front");
  const World world(scene);
  const View view = eye(scene);
  for (int i = 0; i < 32; i++)
    EXPECT_EQ(world.intersect(view_ray(view, float(i) + 0.4f, 11.7f)).instance, uint32_t(front));
}

// In a mirror what turns its back still does, unless the mirror stands before or behind it.
TEST(BackFaces, AMirroredInstanceTurnsAsItsMirrorImageDoes) {
  Scene scene = two_squares(diffuse(vec3(1)));
  mat4& to_world = scene.instances[near_quad].to_world;
  to_world = glm::scale(mat4(1), vec3(-1, 1, 1));
  EXPECT_EQ(seen(scene), far_quad);
  to_world = glm::scale(at({0, 0, 2}), vec3(1, 1, -1));
  EXPECT_EQ(seen(scene), near_quad);
  to_world = glm::scale(at({0, 0, 2}), vec3(-1, 1, -1));  // half a turn
  EXPECT_EQ(seen(scene), near_quad);
}

TEST(BackFaces, AMovingMeshShowsTheSideThatItsMirroringSays) {
  Scene scene = two_squares(diffuse(vec3(1)));
  Mesh mesh = scene.meshes[0];
  scene.instances.erase(scene.instances.begin());
  World world(scene, {mesh}, {1});
  const Ray ray = eye_ray(scene);
  EXPECT_FALSE(world.is_moving(world.intersect(ray).instance));
  world.move(0, mesh.positions, mesh.normals, true);
  world.commit();
  const Hit hit = world.intersect(ray);
  EXPECT_TRUE(world.is_moving(hit.instance));
  EXPECT_TRUE(eval_surface(world, ray, hit).front);
  world.move(0, mesh.positions, mesh.normals);
  world.commit();
  EXPECT_FALSE(world.is_moving(world.intersect(ray).instance));
}

// Many closed and open shells, inwards and outwards, mirrored and not, most of them copies that
// are too many to be laid flat.
Scene shells(int copies, int rings) {
  Scene scene = empty_scene();
  scene.cull_back_faces = true;
  const int one = add_material(scene, diffuse(vec3(0.5f)));
  Material two = diffuse(vec3(0.5f));
  two.double_sided = true;
  const int both = add_material(scene, two);
  Mesh inward = sphere_mesh(one, 0.4f, rings);
  for (uvec3& t : inward.triangles) std::swap(t.y, t.z);
  add_mesh(scene, sphere_mesh(one, 0.4f, rings), "ball", at({-0.5f, 0, 0}));
  add_mesh(scene, inward, "shell", at({0.5f, 0, 0}));
  for (int i = 0; i < copies; i++) {
    const vec3 place(-1.5f + 0.3f * float(i % 11), -0.8f + 0.5f * float(i % 4), -1 - float(i % 3));
    mat4 to_world = glm::scale(at(place), vec3(i % 2 ? -1 : 1, 1, 1));
    scene.instances.push_back({i % 3 ? 1 : 0, to_world, 1});
  }
  add_mesh(scene, box_mesh(both, vec3(12, 12, 12), true), "room");
  return scene;
}

TEST(BackFaces, AllWaysOfAskingAgree) {
  const Scene scene = shells(60, 96);  // over a million triangles in all: copies are instanced
  const World world(scene);
  const View view = eye(scene);
  std::vector<Ray> rays;
  for (int y = 0; y < 32; y++)
    for (int x = 0; x < 32; x++) rays.push_back(view_ray(view, float(x) + 0.4f, float(y) + 0.6f));
  std::vector<Hit> many(rays.size());
  world.intersect_many(rays.data(), many.data(), int(rays.size()));
  std::vector<Hit> each(rays.size());
  for (size_t i = 0; i < rays.size(); i += RayPacket::lanes) {
    RayPacket packet{};
    for (int k = 0; k < RayPacket::lanes; k++) set_ray(rays[i + size_t(k)], k, packet);
    world.intersect_each(packet, 0xffff, &each[i]);
  }
  size_t passed = 0;
  for (size_t i = 0; i < rays.size(); i++) {
    const Hit one = world.intersect(rays[i]);
    EXPECT_EQ(one.instance, many[i].instance);
    EXPECT_NEAR(one.t, many[i].t, 1e-4f);
    EXPECT_EQ(one.instance, each[i].instance);
    EXPECT_TRUE(world.material_of(one.instance).double_sided ||
                eval_surface(world, rays[i], one).front);
    Ray any = rays[i];
    any.from_eye = false;
    passed += world.intersect(any).t < one.t;
  }
  EXPECT_GT(passed, 100u);
}

TEST(BackFaces, TheRasteriserSeesWhatRaysSee) {
  for (bool culled : {true, false}) {
    Scene scene = shells(20, 24);
    scene.cull_back_faces = culled;
    const World world(scene);
    const View view =
        make_view_towards(scene, {0.1, 0.2, 2.8}, {0, 0, 0}, {0, 1, 0}, 0.9f, 160, 120);
    Raster raster(world);
    std::vector<uint32_t> drawn(160 * 120);
    raster.draw(view, {}, [&](const RasterRun& run) {
      for (int i = 0; i < run.count; i++) drawn[size_t(run.y * 160 + run.x + i)] = run.instance[i];
    });
    int other = 0;
    for (int y = 0; y < 120; y++)
      for (int x = 0; x < 160; x++) {
        const Hit hit = world.intersect(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
        other += hit.instance != drawn[size_t(y * 160 + x)];
      }
    EXPECT_LT(other, 20) << culled;  // at edges
  }
}

}  // namespace
}  // namespace wellspring::test
