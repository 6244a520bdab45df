// SPDX-License-Identifier: Apache-2.0
// What the transport plan leaves out, forced on again: the picture stays what it was (bit for bit
// where the estimator is the same, else by a t-test over independent replicates), and what it cost
// is really gone.
#include <gtest/gtest.h>

#include <cstring>

#include "unit/light/full_plan.h"
#include "unit/light/judge.h"
#include "light/virtual/instant_radiosity.h"
#include "light/sample/light_tables.h"
#include "scenes/scenes.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using enum light::TransportPart;

// Memory of what was built for sampling lights.
size_t light_table_bytes(const LightTables& t) {
  size_t bytes = bytes_of(t.emitters, t.emitter_power, t.environment.cells.cells, t.punctual,
                          t.cones, t.punctual_index);
  for (const LightTree* tree : {&t.emitter_choice, &t.near_choice, &t.distant_choice})
    bytes += bytes_of(tree->nodes, tree->leaf_of, tree->strengths.cells, tree->emitting);
  for (const EmissionPicture& picture : t.pictures) bytes += bytes_of(picture.cells.cells);
  return bytes;
}

// A world under its own plan, which leaves `part` out, and under one that has it.
struct BothWays {
  Scene scene;
  World world;
  Lights planned, forced;
  BothWays(Scene scene_, TransportPart part)
      : scene(std::move(scene_)), world(scene), planned(make_lights(world)) {
    TransportPlan plan = test::make_full_plan(scene);
    for (size_t i = 0; i < transport_parts; i++)
      if (TransportPart(i) != part) plan.decisions[i] = planned.tables->plan.decisions[i];
    EXPECT_FALSE(planned.tables->plan.uses(part)) << transport_part_name(part);
    forced = make_lights(world, plan);
  }
  View view(int width, int height) const {
    return make_view_towards(scene, {0.1, 0.5, 0.9}, {0, 0.25, 0}, {0, 1, 0}, 1.0f, width, height);
  }
  Frame render(const Lights& lights, const char* technique = "path") const {
    return render_still(*find_technique(technique), world, lights, view(24, 16), {.spp = 4});
  }
  void expect_same_bits() const {
    for (const char* technique : {"path", "direct"}) {
      Frame a = render(planned, technique), b = render(forced, technique);
      EXPECT_EQ(std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof(vec3)), 0)
          << technique;
      double sum = 0;
      for (vec3 c : a.color) sum += double(luminance(c));
      EXPECT_GT(sum, 1) << technique << ": a dark picture proves nothing";
    }
  }
  void expect_same_mean(double find) const {
    Family family;
    Effort effort{48, 64, 5}, other{48, 64, 6};
    for (const char* name : {"path", "direct"}) {
      const Technique& technique = *find_technique(name);
      family.add_same(name, estimate_radiance(technique, world, planned, view(12, 8), {}, effort),
                      estimate_radiance(technique, world, forced, view(12, 8), {}, other));
    }
    expect_family(family, find);
  }
};

Image picture_of(std::vector<vec4> texels, int width) {
  return Image{.width = width, .height = int(texels.size()) / width, .texels = std::move(texels)};
}

// Floor, lamp, and a ball and a screen in front of it of one material.
Scene scene_with(const Material& material) {
  Scene scene = make_plane_with_rect_light(3);
  int m = add_material(scene, material);
  add_mesh(scene, sphere_mesh(m, 0.2f, 12), "ball", at({0.2f, 0.25f, 0}));
  add_quad(scene, m, {-0.5f, 0, 0.1f}, {0.4f, 0, 0}, {0, 0.5f, 0}, "screen");
  return scene;
}

TEST(PlanSaves, ShadowRaysThatOnlyAskWhetherAnythingIsBetween) {
  Scene scene = scene_with(glass(1.5f, 0.5f, 0));  // thin and rough: declared, but no pane
  BothWays both(scene, panes);
  EXPECT_FALSE(both.planned.tables->any_pane);
  EXPECT_TRUE(both.forced.tables->any_pane);
  EXPECT_TRUE(both.forced.tables->materials.back().maybe_pane);
  both.expect_same_bits();
}

TEST(PlanSaves, WalksThatKeepNoMedium) {
  Material faded = glass(1.5f, 0, 1);
  Scene scene = scene_with(faded);
  scene.materials.back().transmission_texture.texture =
      add_texture(scene, picture_of({vec4(0, 0, 0, 1)}, 1));
  BothWays both(scene, refraction);
  EXPECT_FALSE(both.planned.tables->any_solid);
  EXPECT_TRUE(both.forced.tables->any_solid);
  both.expect_same_bits();
}

// Clear glass that bends all colours alike.
TEST(PlanSaves, TintsAndWavelengthsInClearGlass) {
  Scene scene = scene_with(glass(1.5f, 0, 1));
  BothWays tint(scene, absorption), colors(scene, dispersion);
  EXPECT_TRUE(tint.planned.tables->any_solid);
  EXPECT_FALSE(tint.planned.tables->any_tint);
  EXPECT_TRUE(tint.forced.tables->any_tint);
  tint.expect_same_bits();
  colors.expect_same_bits();
}

// Leaving out what does matter is seen: the tests above could fail.
TEST(PlanSaves, WhatMattersIsMissed) {
  Material tinted = glass(1.5f, 0, 1);
  tinted.attenuation_distance = 0.05f;
  tinted.attenuation_color = vec3(0.2f, 0.8f, 0.5f);
  Scene scene = scene_with(tinted);
  World world(scene);
  TransportPlan plan = make_plan(world);
  ASSERT_TRUE(plan.uses(absorption));
  Lights right = make_lights(world, plan);
  plan.decisions[size_t(absorption)].used = false;
  Lights wrong = make_lights(world, plan);
  View view = make_view_towards(scene, {0.1, 0.5, 0.9}, {0.2, 0.25, 0}, {0, 1, 0}, 0.3f, 12, 8);
  StillSettings settings;
  Frame a = render_still(*find_technique("path"), world, right, view, settings),
        b = render_still(*find_technique("path"), world, wrong, view, settings);
  EXPECT_NE(std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof(vec3)), 0);
}

TEST(PlanSaves, ATreeOverOneLamp) {
  BothWays both(scene_with(diffuse({0.6f, 0.5f, 0.4f})), light_tree);
  EXPECT_LT(light_table_bytes(*both.planned.tables), light_table_bytes(*both.forced.tables));
  both.expect_same_mean(0.02);
}

TEST(PlanSaves, LookingUpALampThatIsTheSameAllOver) {
  size_t lamp = make_plane_with_rect_light(3).materials.size() - 1;
  Scene textured = scene_with(diffuse(vec3(0.5f)));
  textured.materials[lamp].emission_texture.texture =
      add_texture(textured, picture_of(std::vector<vec4>(16, vec4(0.5f)), 4));
  BothWays both(textured, emission_texture);
  for (const EmitterTriangle& e : both.planned.tables->emitters) EXPECT_TRUE(e.uniform);
  for (const EmitterTriangle& e : both.forced.tables->emitters) EXPECT_FALSE(e.uniform);
  ASSERT_FALSE(both.planned.tables->emitters.empty());
  EXPECT_FLOAT_EQ(both.planned.tables->emitters[0].emission.x, 1.5f);
  both.expect_same_mean(0.02);
}

// A scan whose picture carries its light: a million triangles that emit light and light nobody.
TEST(PlanSaves, TablesOfEmittersThatLightNobody) {
  Scene scene = empty_scene();
  Material scan = diffuse({0.7f, 0.6f, 0.5f});
  scan.unlit = true;
  add_sphere(scene, scan, 0.4f, "scan", mat4(1), 32);
  BothWays both(scene, area_lights);
  EXPECT_TRUE(both.planned.tables->emitters.empty());
  EXPECT_EQ(both.forced.tables->emitters.size(), both.scene.meshes[0].triangles.size());
  EXPECT_EQ(light_table_bytes(*both.planned.tables), 0u);
  EXPECT_GT(light_table_bytes(*both.forced.tables), 100000u);
  both.expect_same_bits();
}

TEST(PlanSaves, LampsWithoutPower) {
  Scene scene = scene_with(diffuse(vec3(0.5f)));
  scene.lights.resize(104);
  for (PunctualLight& light : scene.lights) light.intensity = vec3(0);
  BothWays both(scene, punctual_lights);
  EXPECT_TRUE(both.planned.tables->punctual.empty());
  both.expect_same_bits();
}

TEST(PlanSaves, ATableOfASkyThatIsTheSameAllOver) {
  Scene scene = scene_with(diffuse(vec3(0.5f)));
  add_texture(scene, picture_of(std::vector<vec4>(64 * 32, vec4(0.8f, 0.9f, 1, 1)), 64));
  scene.environment = {vec3(1), 0};
  BothWays both(scene, environment_importance);
  EXPECT_TRUE(both.planned.tables->environment.cells.cells.empty());
  EXPECT_EQ(both.forced.tables->environment.cells.cells.size(), 64u * 32u);
  EXPECT_GT(light_table_bytes(*both.forced.tables),
            light_table_bytes(*both.planned.tables) + 64 * 32 * sizeof(AliasTable::Cell) - 1);
  both.expect_same_mean(0.03);
}

TEST(PlanSaves, ASkyThatIsBlack) {
  Scene scene = scene_with(diffuse(vec3(0.5f)));
  add_texture(scene, picture_of(std::vector<vec4>(64, vec4(0, 0, 0, 1)), 8));
  scene.environment = {vec3(1), 0};
  BothWays both(scene, environment);
  EXPECT_EQ(both.planned.tables->environment.image, nullptr);
  EXPECT_NE(both.forced.tables->environment.image, nullptr);
  both.expect_same_bits();
}

TEST(PlanSaves, LightThatNothingKeeps) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  add_sphere(scene, metal({0.9f, 0.8f, 0.7f}, 0), 0.3f, "ball", mat4(1), 12);
  add_quad(scene, 1, {-2, -0.3f, 2}, {4, 0, 0}, {0, 0, -4}, "mirror floor");
  BothWays both(scene, kept_light);
  const Technique& gather = *find_technique("gather");
  vec3 eye = both.view(1, 1).position;
  gather.prepare(both.world, std::span(&eye, 1), both.planned);
  gather.prepare(both.world, std::span(&eye, 1), both.forced);
  EXPECT_EQ(both.planned.known, nullptr);
  Frame a = both.render(both.planned, "gather"), b = both.render(both.forced, "gather");
  EXPECT_EQ(std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof(vec3)), 0);
}

// A scene without anything sharp has no search for caustics: gathering rays end where point lights
// take over.
TEST(PlanSaves, LookingForCaustics) {
  BothWays both(scene_with(plastic({0.6f, 0.5f, 0.4f}, 0.6f)), caustics);
  Transport planned{both.world, *both.planned.tables}, forced{both.world, *both.forced.tables};
  EXPECT_FALSE(draw_instant_pass(planned, {}, 12, 1, 0).sharp);
  EXPECT_TRUE(draw_instant_pass(forced, {}, 12, 1, 0).sharp);
  const Technique& technique = *find_technique("instant_radiosity");
  Family family;
  family.add_same(
      technique.name,
      estimate_radiance(technique, both.world, both.planned, both.view(12, 9), {}, {24, 9, 3}),
      estimate_radiance(technique, both.world, both.forced, both.view(12, 9), {}, {24, 9, 4}));
  expect_family(family, 0.05);
}

// Materials that nothing shows cost no tables: thirty indices of refraction are thirty tables each.
TEST(PlanSaves, TablesOfMaterialsThatNothingShows) {
  Scene scene = scene_with(diffuse(vec3(0.5f)));
  size_t in_use = scene.materials.size();
  for (int i = 0; i < 30; i++) add_material(scene, glass(1.2f + 0.05f * float(i), 0, 1));
  World world(scene);
  Lights lights = make_lights(world);
  ASSERT_EQ(lights.tables->materials.size(), in_use + 30);
  EXPECT_NE(lights.tables->materials[in_use - 1].albedo, nullptr);
  for (size_t i = in_use; i < in_use + 30; i++)
    EXPECT_EQ(lights.tables->materials[i].albedo, nullptr);
}

// Everything at once on a scene that needs nearly nothing.
TEST(PlanSaves, TheWholeFullPlan) {
  Scene scene = scene_with(plastic({0.6f, 0.5f, 0.4f}, 0.5f));
  World world(scene);
  Lights planned = make_lights(world), full = make_lights(world, test::make_full_plan(scene));
  View view = make_view_towards(scene, {0.1, 0.5, 0.9}, {0, 0.25, 0}, {0, 1, 0}, 1.0f, 12, 8);
  Family family;
  for (const char* name : {"path", "direct"})
    family.add_same(name,
                    estimate_radiance(*find_technique(name), world, planned, view, {}, {48, 64, 8}),
                    estimate_radiance(*find_technique(name), world, full, view, {}, {48, 64, 9}));
  expect_family(family, 0.02);
}

}  // namespace
}  // namespace wellspring::test
