// SPDX-License-Identifier: Apache-2.0
// Shadow rays through thin panes, few and many.
#include <gtest/gtest.h>

#include <cmath>

#include "light/sample/lights.h"
#include "light/sample/sample_light.h"

namespace wellspring::test {
namespace {

// A square of so many cells a side in the plane z, a metre around the axis.
Mesh grid(float z, int cells) {
  Mesh mesh;
  auto corner = [&](int x, int y) {
    return vec3(2 * float(x) / float(cells) - 1, 2 * float(y) / float(cells) - 1, z);
  };
  for (int y = 0; y < cells; y++)
    for (int x = 0; x < cells; x++) {
      uint32_t first = uint32_t(mesh.positions.size());
      for (vec3 p : {corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)})
        mesh.positions.push_back(p);
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  mesh.normals.assign(mesh.positions.size(), vec3(0, 0, 1));
  return mesh;
}

// Panes at z = 1, 2, ... before a lamp at z = `panes` + 1; the last material is opaque.
Scene row_of_panes(int panes, int cells = 1) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[0].transmission = 1;
  scene.materials[0].metallic = 0;
  scene.materials[0].roughness = 0;
  scene.materials[0].base_color = {0.9f, 0.8f, 0.95f, 1};
  scene.materials[1].metallic = 0;
  scene.objects = {""};
  for (int i = 1; i <= panes; i++) scene.meshes.push_back(grid(float(i), cells));
  scene.instances.resize(size_t(panes));
  for (int i = 0; i < panes; i++) scene.instances[size_t(i)].mesh = i;
  scene.lights.push_back({.position = {0.1f, 0.2f, float(panes) + 1}, .intensity = vec3(1)});
  return scene;
}

void add_plate(Scene& scene, float z) {
  scene.instances.emplace_back().mesh = int(scene.meshes.size());
  scene.meshes.push_back(grid(z, 1));
  scene.meshes.back().material = 1;
}

SurfacePlace floor_place() {
  return SurfacePlace{.position = {0.13f, 0.17f, 0}, .geometric_normal = {0, 0, 1}, .extent = 1};
}

vec3 visibility(const World& world) {
  Lights lights = make_lights(world);
  Transport transport{world, *lights.tables};
  Sampler sampler(1);
  SurfacePlace from = floor_place();
  LightSample light = sample_punctual_light(transport, from, {0, 0, 1}, false, sampler);
  EXPECT_GT(light.pdf, 0);
  return eval_visibility(transport, from, light);
}

// Computes the light by Fresnel's formulas and the tint alone.
vec3 expected(const World& world, int panes) {
  SurfacePlace from = floor_place();
  Ray ray{.origin = from.position,
          .direction = normalize(world.scene().lights[0].position - from.position)};
  Surface pane = eval_surface(world, ray, world.intersect(ray));
  vec3 once = pane_transmittance(pane, world.scene().materials[0], ray.direction), all(1);
  for (int i = 0; i < panes; i++) all *= once;
  return all;
}

void expect_near(vec3 a, vec3 b) {
  for (int i = 0; i < 3; i++) EXPECT_NEAR(a[i], b[i], 1e-4f * b[i]);
}

TEST(Visibility, EveryPaneTintsOnce) {
  // More than PanesPassed holds, too; finely divided ones, whose tree splits triangles.
  for (int panes : {1, 2, 5, PanesPassed::most, PanesPassed::most + 1, 40})
    for (int cells : {1, 7}) {
      Scene scene = row_of_panes(panes, cells);
      World world(scene);
      expect_near(visibility(world), expected(world, panes));
    }
}

TEST(Visibility, WhatIsOpaqueBlocksWhereverItStands) {
  for (int panes : {1, 3, 40})
    for (float z : {0.5f, float(panes) - 0.5f, float(panes) + 0.5f}) {
      Scene scene = row_of_panes(panes);
      add_plate(scene, z);
      World world(scene);
      EXPECT_EQ(visibility(world), vec3(0)) << panes << " panes, a plate at " << z;
    }
  Scene scene = row_of_panes(3);
  add_plate(scene, 4.5f);  // behind the lamp
  World world(scene);
  expect_near(visibility(world), expected(world, 3));
}

TEST(Visibility, RoughGlassIsNoPane) {
  Scene scene = row_of_panes(2);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[2].roughness = 0.4f;
  scene.meshes[1].material = 2;
  World world(scene);
  EXPECT_EQ(visibility(world), vec3(0));
}

TEST(Visibility, MovingPanesTintAsStillOnes) {
  Scene scene = row_of_panes(3);
  std::vector<Mesh> moving = {scene.meshes[1]};
  scene.instances.erase(scene.instances.begin() + 1);
  World world(scene, moving);
  expect_near(visibility(world), expected(world, 3));
}

// A triangle that the tree holds in several parts is told once: long slivers across one another.
TEST(Visibility, SplitTrianglesAreToldOnce) {
  Scene scene = row_of_panes(1);
  scene.instances.clear();
  scene.meshes.clear();
  constexpr int count = 12;
  for (int i = 0; i < count; i++) {
    float angle = pi * float(i) / count;
    vec3 along = 40.0f * vec3(std::cos(angle), std::sin(angle), 0);
    vec3 across = 0.3f * vec3(-std::sin(angle), std::cos(angle), 0);
    vec3 middle(0.12f, 0.18f, 1 + 0.01f * float(i));
    Mesh mesh{.positions = {middle - along - across, middle + along - across,
                            middle + along + across, middle - along + across}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.emplace_back().mesh = i;
    scene.meshes.push_back(mesh);
  }
  World world(scene);
  SurfacePlace from = floor_place();
  Ray ray{
      .origin = from.position, .direction = scene.lights[0].position - from.position, .t_max = 1};
  PanesPassed panes;
  EXPECT_FALSE(world.occluded(ray, panes));
  EXPECT_FALSE(panes.more);
  EXPECT_EQ(panes.count, count);
  EXPECT_TRUE(world.occluded(ray));  // to those who do not ask, glass is opaque
  expect_near(visibility(world), expected(world, count));
}

}  // namespace
}  // namespace wellspring::test
