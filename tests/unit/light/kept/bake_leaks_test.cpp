// SPDX-License-Identifier: Apache-2.0
// Light stays in its room, however thin the wall.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Two rooms of 2 x 2 x 2 m, left and right of x = 0, on one slab and under one ceiling. Between
// them stands a closed wall. A bulb in the left one.
Scene make_two_rooms(float wall) {
  Scene scene = empty_scene();
  int white = add_material(scene, diffuse(vec3(0.7f)));
  add_mesh(scene, box_mesh(white, {4, 0.2f, 2}), "slab", at({0, -0.1f, 0}));
  add_mesh(scene, box_mesh(white, {4, 0.2f, 2}), "ceiling", at({0, 2.1f, 0}));
  for (float side : {-1.0f, 1.0f}) {
    add_mesh(scene, box_mesh(white, {0.2f, 2.4f, 2.4f}), "outer", at({side * 2.1f, 1, 0}));
    add_mesh(scene, box_mesh(white, {4, 2.4f, 0.2f}), "outer", at({0, 1, side * 1.1f}));
  }
  add_mesh(scene, box_mesh(white, {wall, 2, 2}), "wall", at({0, 1, 0}));
  scene.lights.push_back(test::point_light({-1, 1.2f, 0.2f}, vec3(5)));
  return scene;
}

TEST(BakeLeaks, TheRoomBesideALitOneIsDarkBehindThinWalls) {
  for (float wall : {0.05f, 0.02f}) {
    test::Baked baked(make_two_rooms(wall), {.gather_nodes = 6000, .direct_nodes = 40000});
    auto map = baked.map(4);
    ASSERT_TRUE(map);
    // The mean cell of gathered light, whose nodes are never refined.
    const float cell = float(std::sqrt(baked.bake.charts.area / 6000));
    double lit = 0, lit_places = 0, dark = 0;
    int dark_places = 0;
    vec3 worst(0);
    for (uint32_t t = 0; t < baked.bake.charts.tiles; t++) {
      const TilePlace& at = baked.bake.places[t];
      const IlluminationChart& chart = map->places->charts[at.chart];
      const IlluminationTile& tile = map->tiles[t];
      const ChartSurface& surface = baked.bake.charts.surfaces[at.chart];
      for (uint32_t i = 0; i < tile.nodes(); i++) {
        vec3 place = test::node_place(chart, at, tile, i), inner = place + 0.01f * surface.normal;
        if (std::abs(inner.y - 1) > 1 || std::abs(inner.z) > 1 || std::abs(inner.x) > 2) continue;
        double light = double(luminance(unpack_rgb9e5(map->nodes.light[tile.first + i])));
        if (place.x < -0.5f * wall - 1e-4f) lit += light, lit_places++;
        bool on_wall = std::abs(surface.normal.x) > 0.9f;
        float away = place.x - 0.5f * wall;
        if (away < (on_wall ? -1e-4f : 3 * cell)) continue;
        dark_places++;
        if (light > dark) dark = light, worst = place;
      }
    }
    ASSERT_GT(lit_places, 500);
    ASSERT_GT(dark_places, 500);
    EXPECT_LT(dark, 0.01 * lit / lit_places)
        << wall << ": at " << worst.x << ", " << worst.y << ", " << worst.z;
  }
}

// A lit room of paper, without thickness, in a dark one.
TEST(BakeLeaks, OutsideALitRoomOfPaperItIsDark) {
  Scene scene = empty_scene();
  const int white = add_material(scene, diffuse(vec3(0.7f)));
  Material paper = diffuse(vec3(0.7f));
  paper.double_sided = true;
  add_mesh(scene, box_mesh(white, vec3(4), true), "room");
  add_mesh(scene, box_mesh(add_material(scene, paper), vec3(2)), "paper");
  scene.lights.push_back(test::point_light({0.2f, 0.1f, -0.3f}, vec3(5)));
  test::Baked baked(scene, {.gather_nodes = 3000, .direct_nodes = 6000});
  auto map = baked.map(4);
  ASSERT_TRUE(map);
  double lit = 0;
  int dark = 0;
  for (uint32_t t = 0; t < baked.bake.charts.tiles; t++) {
    const ChartSurface& surface = baked.bake.charts.surfaces[baked.bake.places[t].chart];
    const IlluminationTile& tile = map->tiles[t];
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      const float light = luminance(unpack_rgb9e5(map->nodes.light[tile.first + i]));
      if (surface.back) {
        lit = std::max(lit, double(light));
        continue;
      }
      dark++;
      EXPECT_EQ(light, 0);
    }
  }
  EXPECT_GT(lit, 1);
  EXPECT_GT(dark, 500);
}

}  // namespace
}  // namespace wellspring::test
