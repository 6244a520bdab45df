// SPDX-License-Identifier: Apache-2.0
#include "world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "scenes/build.h"

namespace wellspring::test {
namespace {

vec3 random_vec3(Rng& rng) {
  float x = rng.uniform(), y = rng.uniform(), z = rng.uniform();
  return 2.0f * vec3(x, y, z) - 1.0f;
}

Mesh random_mesh(uint64_t seed, int triangles, float size) {
  Rng rng(seed);
  Mesh mesh;
  for (int i = 0; i < triangles; i++) {
    vec3 centre = random_vec3(rng);
    for (int k = 0; k < 3; k++) {
      mesh.positions.push_back(centre + size * random_vec3(rng));
      mesh.normals.push_back(vec3(0, 1, 0));
    }
    mesh.triangles.push_back(uvec3(uint32_t(3 * i)) + uvec3(0, 1, 2));
  }
  return mesh;
}

// The unit square in z = 0, facing +Z.
Mesh square() {
  Mesh mesh{.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  mesh.normals.assign(4, vec3(0, 0, 1));
  mesh.uv[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Scene scene_of(Mesh mesh) {
  Scene scene;
  scene.materials.resize(1);
  scene.meshes.push_back(std::move(mesh));
  scene.instances.resize(1);
  scene.objects = {""};
  return scene;
}

Ray random_ray(Rng& rng) {
  Ray ray{.origin = 3.0f * normalize(random_vec3(rng))};
  ray.direction = normalize(random_vec3(rng) - ray.origin);
  return ray;
}

// Cramer's rule in double over every triangle.
Hit brute_force(const World& world, const Ray& ray) {
  Hit best;
  double nearest = double(ray.t_max);
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    const Mesh& mesh = world.mesh_of(i);
    for (uint32_t t = 0; t < mesh.triangles.size(); t++) {
      dvec3 p[3];
      for (int k = 0; k < 3; k++)
        p[k] = dvec3(vec3(world.to_world(i) * vec4(mesh.positions[mesh.triangles[t][k]], 1)));
      dvec3 a = p[1] - p[0], b = p[2] - p[0], d(ray.direction), s = dvec3(ray.origin) - p[0];
      double determinant = dot(cross(d, b), a);
      if (determinant == 0) continue;
      double u = dot(cross(d, b), s) / determinant, v = dot(cross(s, a), d) / determinant;
      double distance = dot(cross(s, a), b) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || distance < double(ray.t_min) || distance >= nearest)
        continue;
      nearest = distance;
      best.t = float(distance);
      best.instance = i;
      best.triangle = t;
      best.barycentric = vec2(float(u), float(v));
    }
  }
  return best;
}

void expect_same(const World& world, int rays, uint64_t seed) {
  Rng rng(seed);
  int hits = 0, edge_cases = 0;
  for (int i = 0; i < rays; i++) {
    Ray ray = random_ray(rng);
    Hit expected = brute_force(world, ray), got = world.intersect(ray);
    bool same =
        expected.valid() == got.valid() &&
        (!got.valid() || (got.instance == expected.instance && got.triangle == expected.triangle &&
                          std::abs(got.t - expected.t) < 1e-3f &&
                          length(got.barycentric - expected.barycentric) < 1e-2f));
    edge_cases += !same;  // a ray through an edge may go either way
    hits += got.valid();
    EXPECT_EQ(world.occluded(ray), got.valid());
    Ray shorter = ray;
    if (got.valid()) {
      shorter.t_max = got.t * 0.999f;
      EXPECT_FALSE(world.occluded(shorter));
    }
  }
  EXPECT_LE(edge_cases, rays / 200);
  EXPECT_GT(hits, rays / 10);
}

TEST(World, HitsAreThoseOfBruteForce) {
  Scene scene = scene_of(random_mesh(1, 300, 0.2f));
  expect_same(World(scene), 2000, 11);
}

TEST(World, InstancesScaleTurnAndMirror) {
  Scene scene = scene_of(random_mesh(2, 60, 0.3f));
  scene.instances.clear();
  Rng rng(5);
  for (int i = 0; i < 8; i++) {
    mat4 m = glm::translate(mat4(1), 0.7f * random_vec3(rng));
    m = glm::rotate(m, 6 * rng.uniform(), normalize(random_vec3(rng)));
    m = glm::scale(m, vec3(0.3f + rng.uniform(), 0.4f, i % 2 ? -0.5f : 0.5f));
    scene.instances.push_back({0, m, uint32_t(i)});
  }
  World world(scene);
  expect_same(world, 1000, 12);
  for (uint32_t i = 0; i < 8; i++) EXPECT_EQ(world.object_of(i), i);
}

// More triangles in all than are copied flat, so Embree instances are at work.
TEST(World, ThousandsOfInstances) {
  Scene scene = scene_of(random_mesh(3, 600, 0.3f));
  scene.instances.clear();
  for (int x = 0; x < 50; x++)
    for (int z = 0; z < 50; z++) {
      Instance instance{.to_world = glm::translate(mat4(1), vec3(4 * x, 0, 4 * z))};
      instance.to_world = glm::scale(instance.to_world, vec3(1, 0.5f, 1));
      scene.instances.push_back(instance);
    }
  scene.instances.push_back(  // flattened: has no inverse
      {0, glm::scale(glm::translate(mat4(1), vec3(-9, 0, 0)), vec3(1, 1, 0)), 0});
  World world(scene);
  Scene alone_scene = scene_of(random_mesh(3, 600, 0.3f));
  alone_scene.instances[0].to_world = glm::scale(mat4(1), vec3(1, 0.5f, 1));
  World alone(alone_scene);
  Rng rng(3);
  int hits = 0;
  for (int i = 0; i < 300; i++) {
    Ray ray = random_ray(rng);
    ray.t_max = 4;
    Hit here = alone.intersect(ray);
    int x = int(50 * rng.uniform()), z = int(50 * rng.uniform());
    ray.origin += vec3(4 * x, 0, 4 * z);
    ray.t_min = 0;
    Hit there = world.intersect(ray);
    if (!here.valid()) continue;
    hits++;
    ASSERT_TRUE(there.valid());
    if (there.instance != uint32_t(50 * x + z)) continue;  // a neighbour stood before it
    EXPECT_EQ(there.triangle, here.triangle);
    EXPECT_NEAR(there.t, here.t, 1e-3f);
    vec3 normal = normalize(world.normal_to_world(there.instance) * vec3(1, 1, 1));
    vec3 expected = normalize(vec3(1, 2, 1));
    EXPECT_NEAR(dot(normal, expected), 1, 1e-5f);
  }
  EXPECT_GT(hits, 60);
  Ray at_flat{.origin = vec3(-9, 0, 5)};
  EXPECT_TRUE(world.intersect(at_flat).valid());
}

TEST(World, ManyRaysAtOnceAgreeWithOneByOne) {
  Scene scene = scene_of(random_mesh(4, 200, 0.3f));
  World world(scene, {random_mesh(5, 40, 0.4f)}, {0});
  Rng rng(9);
  for (int count : {0, 1, 7, 8, 9, 61}) {
    std::vector<Ray> rays;
    for (int i = 0; i < count; i++) rays.push_back(random_ray(rng));
    if (count > 7) rays[3].direction = vec3(std::nanf(""));
    std::vector<Hit> hits(static_cast<size_t>(count));
    world.intersect_many(rays.data(), hits.data(), count);
    for (int i = 0; i < count; i++) {
      Hit one = world.intersect(rays[size_t(i)]);
      EXPECT_EQ(hits[size_t(i)].instance, one.instance);
      if (!one.valid()) continue;
      EXPECT_EQ(hits[size_t(i)].triangle, one.triangle);
      EXPECT_NEAR(hits[size_t(i)].t, one.t, 1e-4f);
    }
  }
}

TEST(World, MovingMeshMovesHidesAndReturns) {
  Scene scene = scene_of(square());
  World world(scene, {square()}, {7});
  EXPECT_TRUE(world.is_moving(1));
  EXPECT_EQ(world.object_of(1), 7u);
  Ray ray{.origin = vec3(0.5f, 0.5f, 5)};
  auto place = [&](vec3 offset) {
    Mesh mesh = square();
    for (vec3& p : mesh.positions) p += offset;
    world.move(0, mesh.positions, mesh.normals);
    world.commit();
  };
  place(vec3(0, 0, 2));
  Hit hit = world.intersect(ray);
  EXPECT_EQ(hit.instance, 1u);
  EXPECT_NEAR(hit.t, 3, 1e-5f);
  place(vec3(30, 0, 1));
  EXPECT_EQ(world.intersect(ray).instance, 0u);
  ray.origin.x += 30;
  EXPECT_NEAR(world.intersect(ray).t, 4, 1e-5f);
  EXPECT_TRUE(world.occluded(ray));
  world.show(0, false);
  world.commit();
  EXPECT_FALSE(world.intersect(ray).valid());
  EXPECT_FALSE(world.occluded(ray));
  world.show(0, true);
  world.commit();
  EXPECT_TRUE(world.intersect(ray).valid());
  EXPECT_EQ(world.mesh_of(1).positions[0], vec3(30, 0, 1));
}

TEST(World, MovingMeshMatchesBruteForceAfterManyMoves) {
  Scene scene = scene_of(random_mesh(6, 20, 0.2f));
  Mesh mesh = random_mesh(7, 100, 0.2f);
  World world(scene, {mesh}, {0});
  Rng rng(8);
  for (int step = 0; step < 20; step++) {
    for (vec3& p : mesh.positions) p = 0.9f * p + 0.15f * random_vec3(rng);
    world.move(0, mesh.positions, mesh.normals);
    world.commit();
  }
  expect_same(world, 500, 13);
}

TEST(World, VerticesThatAreNotFiniteStayWhereTheyWere) {
  Scene scene = scene_of(square());
  World world(scene, {square()}, {0});
  std::vector<vec3> positions(4, vec3(std::nanf("")));
  positions[0] = vec3(0, 0, 1);
  world.move(0, positions, std::vector<vec3>(4, vec3(0, 0, 1)));
  world.commit();
  EXPECT_EQ(world.mesh_of(1).positions[0], vec3(0, 0, 1));
  EXPECT_EQ(world.mesh_of(1).positions[2], vec3(1, 1, 0));
  EXPECT_THROW(world.move(0, std::vector<vec3>(3), std::vector<vec3>(4)), std::invalid_argument);
}

TEST(World, NothingAndSliversAreSafe) {
  Scene nothing;
  nothing.materials.resize(1);
  World empty(nothing);
  EXPECT_FALSE(empty.intersect(Ray()).valid());
  EXPECT_FALSE(empty.occluded(Ray()));
  Hit hit;
  Ray ray;
  empty.intersect_many(&ray, &hit, 1);
  EXPECT_FALSE(hit.valid());

  Mesh slivers;  // a point, a line, a triangle with a missing corner, an empty mesh
  slivers.positions = {{0, 0, -1}, {1, 0, -1}, {2, 0, -1}, {std::nanf(""), 0, -1}};
  slivers.normals.assign(4, vec3(0, 1, 0));
  slivers.triangles = {{0, 0, 0}, {0, 1, 2}, {0, 1, 3}};
  Scene scene = scene_of(slivers);
  scene.meshes.push_back(Mesh());
  scene.instances.push_back({1, mat4(1), 0});
  World world(scene, {Mesh()}, {0});
  world.move(0, {}, {});
  world.commit();
  Rng rng(2);
  for (int i = 0; i < 100; i++) EXPECT_FALSE(world.intersect(random_ray(rng)).valid());
}

TEST(World, RaysThatAreNotFiniteHitNothing) {
  Scene scene = scene_of(square());
  World world(scene);
  float bad = std::nanf("");
  Ray good{.origin = vec3(0.5f, 0.25f, 1)};
  EXPECT_TRUE(world.occluded(good));
  for (int i = 0; i < 6; i++) {
    Ray ray = good;
    (i < 3 ? ray.origin : ray.direction)[i % 3] = i % 2 ? bad : INFINITY;
    EXPECT_FALSE(world.intersect(ray).valid());
    EXPECT_FALSE(world.occluded(ray));
  }
  Ray still = good;
  still.direction = vec3(0);
  EXPECT_FALSE(world.intersect(still).valid());
}

// Left half of the square's picture is transparent.
Scene window_scene(AlphaMode mode, uint8_t left_alpha) {
  Scene scene = scene_of(square());
  Image image{.width = 2, .height = 1, .texels8 = {255, 255, 255, left_alpha, 255, 255, 255, 255}};
  scene.materials[0].base_color_texture.texture = scenes::add_texture(scene, image, true);
  scene.materials[0].alpha_mode = mode;
  return scene;
}

TEST(World, MaskedSurfacesHaveHoles) {
  Scene scene = window_scene(AlphaMode::mask, 0);
  World world(scene, {}, {});
  Rng rng(1);
  std::vector<Ray> rays(64);
  std::vector<Hit> hits(64);
  for (Ray& ray : rays) ray.origin = vec3(rng.uniform(), rng.uniform(), 1);
  world.intersect_many(rays.data(), hits.data(), 64);
  for (int i = 0; i < 64; i++) {
    bool solid = rays[size_t(i)].origin.x >= 0.5f;
    EXPECT_EQ(world.intersect(rays[size_t(i)]).valid(), solid);
    EXPECT_EQ(world.occluded(rays[size_t(i)]), solid);
    EXPECT_EQ(hits[size_t(i)].valid(), solid);
  }
  Scene opaque = window_scene(AlphaMode::opaque, 0);
  EXPECT_TRUE(World(opaque).occluded(rays[0]));
}

TEST(World, MaskedInstancesHaveHolesWhereTheyStand) {
  Scene scene = window_scene(AlphaMode::mask, 0);
  scene.meshes[0].triangles.resize(4000, uvec3(0, 0, 0));  // padding that is never hit
  scene.instances.clear();
  for (int i = 0; i < 400; i++)
    scene.instances.push_back({0, glm::translate(mat4(1), vec3(2 * i, 0, 0)), 0});
  World world(scene);
  for (int i : {0, 17, 399}) {
    Ray ray{.origin = vec3(2 * i + 0.25f, 0.5f, 1)};
    EXPECT_FALSE(world.intersect(ray).valid());
    ray.origin.x += 0.5f;
    EXPECT_EQ(world.intersect(ray).instance, uint32_t(i));
  }
}

TEST(World, BlendedSurfacesPassTheRightShareAndRepeat) {
  Scene scene = window_scene(AlphaMode::blend, 77);  // alpha 0.302
  World world(scene);
  Rng rng(4);
  int hits = 0, count = 20000;
  std::vector<Ray> rays(static_cast<size_t>(count));
  std::vector<Hit> many(static_cast<size_t>(count));
  for (Ray& ray : rays) ray.origin = vec3(0.5f * rng.uniform(), rng.uniform(), 1);
  world.intersect_many(rays.data(), many.data(), count);
  for (int i = 0; i < count; i++) {
    bool hit = world.intersect(rays[size_t(i)]).valid();
    EXPECT_EQ(hit, world.occluded(rays[size_t(i)]));
    EXPECT_EQ(hit, world.intersect(rays[size_t(i)]).valid());
    EXPECT_EQ(hit, many[size_t(i)].valid());
    hits += hit;
  }
  double alpha = 77.0 / 255.0, deviation = std::sqrt(count * alpha * (1 - alpha));
  EXPECT_NEAR(hits, count * alpha, 4 * deviation);
}

TEST(World, WrongScenesAreRefused) {
  Scene scene = scene_of(square());
  scene.meshes[0].triangles[0].x = 99;
  EXPECT_THROW(World{scene}, std::invalid_argument);
  scene = scene_of(square());
  scene.instances[0].mesh = 5;
  EXPECT_THROW(World{scene}, std::invalid_argument);
  scene = scene_of(square());
  scene.meshes[0].material = -1;
  EXPECT_THROW(World{scene}, std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
