// SPDX-License-Identifier: Apache-2.0
// Scenes that break path tracers: every sample must be finite, and the answer right where it is
// known.
#include <limits>

#include "scenes/lit_world.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();

// Renders with every technique; nothing may be dropped.
void expect_clean(const Scene& scene, const View& view, const char* what) {
  World world(scene);
  Lights lights = make_lights(world);
  StillSettings settings{.spp = 4};
  for (const Technique& technique : techniques()) {
    Frame frame = render_still(technique, world, lights, view, settings);
    for (vec3 c : frame.color)
      ASSERT_TRUE(is_finite(c) && c.x >= 0) << what << ", " << technique.name;
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u) << what;
}

View small_view(const Scene& scene) { return cornell_view(scene, 24, 24); }

TEST(HardCases, LightsWithoutAreaOrPower) {
  Scene scene = make_cornell_box();
  int lamp = add_material(scene, emitter(vec3(5))), dark = add_material(scene, emitter(vec3(0)));
  add_quad(scene, lamp, {0, 0.2f, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}, "line");
  add_quad(scene, lamp, {0, 0.2f, 0}, {0, 0, 0}, {0, 0, 0}, "dot");
  add_quad(scene, lamp, {0, 0.2f, -0.2f}, {0.1f, 0, 0}, {0, 0, 1e-9f}, "sliver");
  add_quad(scene, dark, {0, 0.3f, -0.2f}, {0.1f, 0, 0}, {0, 0, 0.1f}, "dark");
  scene.lights.push_back({.intensity = vec3(0)});
  expect_clean(scene, small_view(scene), "lights without area or power");
}

TEST(HardCases, PointLightOnTheSurfaceItself) {
  PunctualLight light{.position = {0, 0, 0}};
  Scene scene = make_plane_with_punctual(light);
  expect_clean(scene, make_view_towards(scene, {0, 1, 0.01}, {0, 0, 0}, {0, 0, -1}, 0.01f, 9, 9),
               "touching light");
  World world(scene);
  Lights lights = make_lights(world);
  Request request{.ray = ray_towards({0, 1, 0}, {0, 0, 0})};
  EXPECT_TRUE(is_finite(find_technique("path")->trace(world, lights, {}, request).radiance()));
}

TEST(HardCases, EveryRoughnessAndIndex) {
  for (float roughness : {0.0f, 1e-4f, 0.032f, 1.0f})
    for (float ior : {1.0f, 1.5f, 0.0f, 3.0f})
      for (float thickness : {0.0f, 1.0f})
        for (float metallic : {0.0f, 0.5f, 1.0f}) {
          Scene scene = make_cornell_box();
          Material m = glass(ior, roughness, thickness);
          m.metallic = metallic;
          add_sphere(scene, m, 0.1f, "ball", at({0, 0.3f, -0.1f}), 12);
          expect_clean(scene, cornell_view(scene, 12, 12), "roughness and index");
        }
}

TEST(HardCases, CameraOnAWallAndInsideGlass) {
  Scene scene = make_cornell_box();
  add_sphere(scene, glass(1.5f, 0, 1), 0.2f, "ball", at({0, 0.3f, 0.8f}));
  expect_clean(scene, small_view(scene), "eye inside glass");
  expect_clean(scene, make_view_towards(scene, {0, 0.2, -0.56}, {0, 0.2, 0}, {0, 1, 0}, 1, 16, 16),
               "eye on a wall");
  expect_clean(scene,
               make_view_towards(scene, {-0.28, 0, -0.56}, {0, 0.2, 0}, {0, 1, 0}, 1, 16, 16),
               "eye in a corner");
}

TEST(HardCases, TexelsThatAreNoNumbers) {
  Scene scene = make_cornell_box();
  Image image{.width = 2,
              .height = 2,
              .texels = {vec4(not_a_number), vec4(infinity), vec4(-infinity), vec4(0.5f)}};
  int texture = add_texture(scene, image);
  for (Material& m : scene.materials) {
    m.base_color_texture.texture = texture;
    m.metallic_roughness_texture.texture = texture;
    m.normal_texture.texture = texture;
    m.emission_texture.texture = texture;
  }
  scene.environment = {vec3(1), 0};
  expect_clean(scene, small_view(scene), "texels");
}

TEST(HardCases, LampInTheCeilingPlane) {
  Scene scene = make_cornell_box();
  for (Mesh& mesh : scene.meshes)  // the lamp lifted into its ceiling
    for (vec3& p : mesh.positions)
      if (p.y > 0.54f) p.y = 0.55f;
  expect_clean(scene, small_view(scene), "coplanar light and wall");
}

TEST(HardCases, LampInsideALens) {
  Scene scene = empty_scene();
  add_floor(scene, 0.5f);
  add_sphere(scene, emitter(vec3(5)), 0.1f, "lamp", at({0, 1, 0}));
  add_sphere(scene, glass(1.5f, 0, 1), 0.2f, "lens", at({0, 1, 0}));
  expect_clean(scene, make_view_towards(scene, {0, 1, 2}, {0, 0.7, 0}, {0, 1, 0}, 1, 20, 20),
               "lamp in a lens");
  World world(scene);
  Lights lights = make_lights(world);
  EXPECT_GT(trace_mean("path", world, lights, ray_towards({0, 1, 2}, {0.1f, 0, 0.1f}), 4000).mean(),
            0);
}

TEST(HardCases, NestedAndCoincidentGlass) {
  Scene scene = make_cornell_box();
  int m = add_material(scene, glass(1.5f, 0, 1));
  for (float radius : {0.15f, 0.1f, 0.1f})
    add_mesh(scene, sphere_mesh(m, radius), "ball", at({0, 0.3f, 0}));
  add_mesh(scene, box_mesh(m, {0.2f, 0.2f, 0.2f}), "box", at({0.1f, 0.1f, 0.05f}));
  expect_clean(scene, small_view(scene), "nested glass");
}

TEST(HardCases, ManyPanesInARow) {
  Scene scene = empty_scene();
  int pane = add_material(scene, glass(1, 0, 0));  // index 1: nothing is lost
  for (int i = 0; i < 20; i++) add_quad(scene, pane, {-2, -2, float(i)}, {4, 0, 0}, {0, 4, 0});
  scene.environment.radiance = vec3(1);
  World world(scene);
  Lights lights = make_lights(world);
  EXPECT_NEAR(trace_mean("path", world, lights, ray_towards({0, 0, 30}, {0, 0, 0}), 100).mean(), 1,
              1e-5);
}

TEST(HardCases, RaysThatAreNoRays) {
  auto [scene, world, lights] = LitWorld(make_cornell_box());
  for (vec3 direction : {vec3(0), vec3(not_a_number), vec3(infinity, 0, 0)})
    for (vec3 origin : {vec3(0, 0.2f, 0.8f), vec3(not_a_number), vec3(1e17f)})
      for (const Technique& technique : techniques()) {
        Request request;
        request.ray.origin = origin;
        request.ray.direction = direction;
        EXPECT_TRUE(is_finite(technique.trace(world, lights, {}, request).radiance()));
      }
}

TEST(HardCases, EmptyScene) {
  Scene scene = empty_scene();
  expect_clean(scene, make_view_towards(scene, {0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 1, 4, 4), "empty");
}

}  // namespace
}  // namespace wellspring::test
