// SPDX-License-Identifier: Apache-2.0
// Kept light: the technique `gather` against the reference and against a formula.
#include <gtest/gtest.h>

#include <cmath>

#include "light/radiance_grid.h"
#include "light/technique.h"
#include "light/walk.h"
#include "scenes/scenes.h"

namespace wellspring {
namespace {

dvec3 mean_of(const Frame& frame) {
  dvec3 sum(0);
  for (vec3 c : frame.color) sum += dvec3(c);
  return sum / double(frame.color.size());
}

struct Prepared {
  Scene scene;
  World world;
  Lights lights;
  explicit Prepared(Scene scene_, vec3 place) : scene(std::move(scene_)), world(scene), lights(make_lights(world)) {
    find_technique("gather")->prepare(world, std::span(&place, 1), lights);
  }
};

TEST(Gather, FurnaceHasItsAnswerInEveryCell) {
  Prepared p(scenes::make_furnace(0.5f), vec3(0));
  ASSERT_TRUE(p.lights.grid);
  int asked = 0;
  for (size_t i = 0; i < p.lights.grid->keys.size(); i++) {
    if (p.lights.grid->count[i] < 200) continue;
    asked++;
    // Scattered light over reflectance is the radiance itself, 1 / (1 - 1/2), less what walks longer than
    // max_depth would still bring: 2^-5 of it at the most. Emission tells the standard error of a cell.
    EXPECT_NEAR(p.lights.grid->light[i].x, 2, 0.15) << "cell " << i;
  }
  EXPECT_GT(asked, 50);
}

TEST(Gather, AgreesWithPathInTheCornellBox) {
  Prepared p(scenes::make_cornell_box(), vec3(0, 0.27f, 0.3f));
  View view = scenes::cornell_view(p.scene, 48, 48);
  StillSettings settings;
  settings.spp = 64;
  dvec3 reference = mean_of(render_still(*find_technique("path"), p.world, p.lights, view, settings));
  dvec3 gathered = mean_of(render_still(*find_technique("gather"), p.world, p.lights, view, settings));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(gathered[c] / reference[c], 1, 0.04);
}

TEST(Gather, WithoutAGridItIsPathBitForBit) {
  Scene scene = scenes::make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  View view = scenes::cornell_view(scene, 16, 16);
  StillSettings settings;
  settings.spp = 2;
  Frame a = render_still(*find_technique("path"), world, lights, view, settings);
  Frame b = render_still(*find_technique("gather"), world, lights, view, settings);
  EXPECT_EQ(a.color, b.color);
}

TEST(Gather, TheGridIsTheSameEachTime) {
  Scene scene = scenes::make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  vec3 place(0, 0.27f, 0.3f);
  RadianceGridSettings settings;
  settings.paths = 20000;
  auto a = make_radiance_grid({world, *lights.tables}, std::span(&place, 1), settings);
  auto b = make_radiance_grid({world, *lights.tables}, std::span(&place, 1), settings);
  EXPECT_EQ(a->keys, b->keys);
  EXPECT_EQ(a->light, b->light);
  EXPECT_GT(std::count_if(a->count.begin(), a->count.end(), [](float n) { return n >= 12; }), 100);
}

TEST(Gather, NoPlacesNoGeometryNoHarm) {
  Scene scene = scenes::empty_scene();
  World world(scene);
  Lights lights = make_lights(world);
  vec3 place(0);
  find_technique("gather")->prepare(world, {}, lights);
  find_technique("gather")->prepare(world, std::span(&place, 1), lights);
  StillSettings settings;
  settings.spp = 1;
  View view;
  Frame frame = render_still(*find_technique("gather"), world, lights, view, settings);
  EXPECT_EQ(frame.color[0], vec3(0));
}

TEST(Gather, AMirrorIsNotAskedAndANarrowFootprintIsRefused) {
  Prepared p(scenes::make_furnace(0.5f), vec3(0));
  Ray ray;
  ray.direction = vec3(0, 0, -1);
  Surface surface = eval_surface(p.world, ray, p.world.intersect(ray));
  const Material& material = p.scene.materials[size_t(surface.material)];
  Bsdf bsdf = make_bsdf(surface, material, ray.direction, *p.lights.tables->materials[size_t(surface.material)].albedo);
  vec3 light;
  EXPECT_TRUE(eval_grid(*p.lights.grid, surface, bsdf, false, 10, light));
  EXPECT_FALSE(eval_grid(*p.lights.grid, surface, bsdf, false, 0.1f * p.lights.grid->cell, light));
  EXPECT_FALSE(eval_grid(*p.lights.grid, surface, bsdf, true, 10, light));
  bsdf.alpha = 0.01f;
  EXPECT_FALSE(eval_grid(*p.lights.grid, surface, bsdf, false, 10, light));
}

}  // namespace
}  // namespace wellspring
