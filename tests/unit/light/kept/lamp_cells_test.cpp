// SPDX-License-Identifier: Apache-2.0
#include "light/kept/lamps.h"

#include <gtest/gtest.h>

#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

vec3 daylight(vec3 place) { return {0.25f, 0.5f, 0.75f + 0.1f * place.x}; }
vec3 lamplight(vec3 place) { return vec3(2 + place.z); }

struct LampCellsTest : testing::Test {
  Scene scene = scenes::empty_scene();
  // A floor of 4 x 4 m, seen from above alone.
  LampCellsTest() {
    test::add_fan(scene, scenes::add_material(scene, scenes::diffuse(vec3(0.5f))), {-2, 0.01f, 2},
                  {4, 0, 0}, {0, 0, -4});
  }
};

TEST_F(LampCellsTest, KnowTheLightOfEachLampWhereTheSurfaceIs) {
  const World world(scene);
  const auto map = test::paint_map(world, 0.25f, {daylight, lamplight});
  const LampCells cells = make_lamp_cells(world, *map);
  ASSERT_EQ(cells.light.size(), 2u);
  EXPECT_GT(cells.cells.size(), 1000u);
  double area = 0;
  for (float weight : cells.weight) area += double(weight);
  EXPECT_NEAR(area, 16, 0.01);
  for (vec3 place : {vec3(-1.5f, 0.01f, 1.2f), vec3(0.3f, 0.01f, -0.4f), vec3(1.9f, 0.01f, 1.9f)}) {
    const uint32_t cell = find_lamp_cell(cells, place, {0, 1, 0});
    ASSERT_NE(cell, no_lamp_cell);
    EXPECT_LT(length(cells.light[0][cell] - daylight(place)), 0.03f);
    EXPECT_LT(length(cells.light[1][cell] - lamplight(place)), 0.15f);
  }
}

TEST_F(LampCellsTest, AnotherSideAndEmptySpaceAreNotKnown) {
  const World world(scene);
  const LampCells cells = make_lamp_cells(world, *test::paint_map(world, 0.25f, {daylight}));
  EXPECT_EQ(find_lamp_cell(cells, {0.3f, 0.01f, -0.4f}, {1, 0, 0}), no_lamp_cell);
  EXPECT_EQ(find_lamp_cell(cells, {0.3f, 1, -0.4f}, {0, 1, 0}), no_lamp_cell);
}

TEST_F(LampCellsTest, NothingThatIsKnownHasNoCells) {
  const Scene empty = scenes::empty_scene();
  const World world(empty);
  const LampCells cells = make_lamp_cells(world, *test::paint_map(world, 0.25f, {daylight}));
  EXPECT_TRUE(cells.cells.empty());
  EXPECT_EQ(find_lamp_cell(cells, vec3(0), {0, 1, 0}), no_lamp_cell);
}

}  // namespace
}  // namespace wellspring::test
