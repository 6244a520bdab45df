// SPDX-License-Identifier: Apache-2.0
// Limits of numbers and sizes: what is dropped is counted, tiny numbers do no harm, one pixel and
// thousands of instances are pictures like others.
#include <cmath>
#include <limits>

#include "unit/light/judge.h"
#include "scenes/lit_world.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float denormal = 1e-40f;

// A picture of every technique, finite and not negative.
void expect_light(const Scene& scene, const View& view, const char* what) {
  World world(scene);
  const Lights lights = make_lights(world);
  StillSettings settings{.spp = 4};
  for (const Technique& technique : techniques()) {
    Lights own = lights;
    if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), own);
    Frame frame = render_still(technique, world, own, view, settings);
    for (vec3 c : frame.color)
      ASSERT_TRUE(is_finite(c) && std::min({c.x, c.y, c.z}) >= 0) << what << ", " << technique.name;
  }
  EXPECT_EQ(lights.bad_samples->load(), 0u) << what;
}

// Every technique drops what is no light, shows black in its place and counts it.
TEST(HardCases, EveryTechniqueCountsWhatItDrops) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  for (vec3 radiance : {vec3(infinity, 1, 1), vec3(std::nanf(""), 1, 1), vec3(1, -1, 1)}) {
    Scene scene = empty_scene();
    add_wall(scene, emitter(radiance), 0, 9, "quad");
    World world(scene);
    View view = make_view_towards(scene, {0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 1.0f, 8, 8);
    StillSettings settings{.spp = 3};
    for (const Technique& technique : techniques()) {
      Lights lights = make_lights(world);
      Frame frame = render_still(technique, world, lights, view, settings);
      for (vec3 c : frame.color) ASSERT_EQ(c, vec3(0)) << technique.name;
      EXPECT_EQ(lights.bad_samples->load(), 8u * 8 * 3) << technique.name;
    }
  }
}

TEST(HardCases, OrdinaryScenesDropNothing) {
  Scene scene = make_cornell_box();
  add_sphere(scene, glass(1.5f, 0.2f, 1), 0.08f, "glass", at({0.1f, 0.3f, -0.1f}), 16);
  add_sphere(scene, metal(vec3(0.9f), 0.1f), 0.08f, "metal", at({-0.1f, 0.45f, -0.1f}), 16);
  expect_light(scene, cornell_view(scene, 48, 48), "ordinary");
}

TEST(HardCases, NumbersThatAreNearlyNothing) {
  Scene scene = make_cornell_box();
  int faint = add_material(scene, emitter(vec3(denormal)));
  add_quad(scene, faint, {-0.1f, 0.2f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, "faint");
  int lamp = add_material(scene, emitter(vec3(5)));
  add_quad(scene, lamp, {0.1f, 0.2f, 0}, {denormal, 0, 0}, {0, 0.1f, 0}, "thin");
  add_quad(scene, lamp, {0.1f, 0.3f, 0}, {1e-20f, 0, 0}, {0, 1e-20f, 0}, "small");
  add_sphere(scene, glass(1.5f, 0, denormal), 1e-18f, "dust", at({0, 0.3f, 0}), 8);
  PunctualLight light{.position = {0, 0.4f, 0}, .intensity = vec3(denormal)};
  scene.lights.push_back(light);
  light.range = denormal;
  light.intensity = vec3(1);
  scene.lights.push_back(light);
  light.type = PunctualType::spot;
  light.range = std::numeric_limits<float>::infinity();
  light.inner_cone = light.outer_cone = denormal;
  scene.lights.push_back(light);
  expect_light(scene, cornell_view(scene, 24, 24), "denormal");
  scene.environment.radiance = vec3(denormal);
  expect_light(scene, cornell_view(scene, 24, 24), "denormal sky");
}

// A single pixel is the mean of the picture that covers the same angle.
TEST(HardCases, PictureOfOnePixel) {
  auto [scene, world, lights] = LitWorld(make_cornell_box());
  View many = cornell_view(scene, 16, 16), one = cornell_view(scene, 1, 1);
  expect_light(scene, one, "one pixel");
  Family family;
  for (const Technique& technique : techniques()) {
    if (technique.prepare || technique.begin_pass) continue;  // too many passes
    family.add_same(technique.name,
                    estimate_radiance(technique, world, lights, one, {}, {32, 2048, 1}),
                    estimate_radiance(technique, world, lights, many, {}, {32, 8, 2}));
  }
  expect_family(family, 0.15);  // the lamp is most of the light and few of the samples
}

// A floor laid with 10,000 instances of one tile is the floor in one piece.
TEST(HardCases, ThousandsOfInstances) {
  Scene whole = make_plane_with_rect_light(10), tiled = whole;
  tiled.instances.erase(tiled.instances.begin());
  Mesh tile{.material = whole.meshes[0].material};
  append_quad(tile, {0, 0, 0.4f}, {0.4f, 0, 0}, {0, 0, -0.4f});
  tiled.meshes.push_back(tile);
  for (int i = 0; i < 100; i++)
    for (int j = 0; j < 100; j++)
      tiled.instances.push_back(
          {int(tiled.meshes.size()) - 1, at({-20 + 0.4f * float(i), 0, -20 + 0.4f * float(j)}), 1});
  World one(whole), thousands(tiled);
  Lights lamp = make_lights(one), same_lamp = make_lights(thousands);
  Family family;
  for (vec3 p : {vec3(0, 0, 0), vec3(3.1f, 0, 2.2f)})
    for (const Technique& technique : techniques()) {
      if (technique.prepare) continue;
      View view = view_along(ray_towards(p + vec3(0.1f, 1, 0.4f), p), technique);
      family.add_same(technique.name,
                      estimate_radiance(technique, one, lamp, view, {}, {32, 64, 1}),
                      estimate_radiance(technique, thousands, same_lamp, view, {}, {32, 64, 2}));
    }
  expect_family(family);
}

TEST(HardCases, AMillionSamplesDoNotDrift) {
  Scene scene = empty_scene();
  scene.environment.radiance = {0.1f, 0.3f, 1000.1f};
  World world(scene);
  StillSettings settings{.spp = 1000000};
  View view = make_view_towards(scene, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1, 1, 1);
  Frame frame = render_still(*find_technique("path"), world, make_lights(world), view, settings);
  EXPECT_EQ(frame.color[0], scene.environment.radiance);
}

}  // namespace
}  // namespace wellspring::test
