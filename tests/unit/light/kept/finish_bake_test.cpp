// SPDX-License-Identifier: Apache-2.0
#include "light/kept/finish_bake.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// A surface's charts, cells as `choose` says of each tile's number, and light of nobody's making.
struct Tiles {
  Scene scene;
  World world;
  BakeCharts charts;
  std::vector<IlluminationTile> tiles;
  std::vector<vec3> light;
  template <class Choose>
  Tiles(Mesh mesh, float tile, const Choose& choose)
      : scene(scene_of(std::move(mesh))), world(scene), charts(make_charts(world, tile)) {
    std::vector<TileCells> cells = find_occupied(world, charts);
    for (uint32_t t = 0; t < cells.size(); t++)
      if (cells[t].columns > 0) cells[t] = choose(t);
    tiles = make_field(world, charts, cells, 1).tiles;
    light.resize(node_count(cells));
    for (size_t i = 0; i < light.size(); i++)
      light[i] = vec3(float(mix64(i) >> 40) * (1.0f / (1 << 24)));
  }
  static Scene scene_of(Mesh mesh) {
    Scene scene = empty_scene();
    mesh.material = add_material(scene, diffuse(vec3(0.5f)));
    add_mesh(scene, std::move(mesh), "it");
    return scene;
  }
  // Returns the light at u, v from 0 to 1 of one tile, as it lies there.
  float at(uint32_t tile, float u, float v) const {
    const IlluminationTile& t = tiles[tile];
    u *= float(t.columns), v *= float(t.rows);
    int i = std::min(int(u), t.columns - 1), j = std::min(int(v), t.rows - 1);
    u -= float(i), v -= float(j);
    auto node = [&](int x, int y) { return light[t.first + uint32_t(y * (t.columns + 1) + x)].x; };
    return glm::mix(glm::mix(node(i, j), node(i + 1, j), u),
                    glm::mix(node(i, j + 1), node(i + 1, j + 1), u), v);
  }
  // The largest jump between tiles of the first chart, which has no gaps.
  float border_jump() const {
    const IlluminationChart& chart = charts.places->charts[0];
    float most = 0;
    for (int row = 0; row < chart.rows; row++)
      for (int column = 0; column < chart.columns; column++)
        for (int k = 0; k <= 64; k++) {
          float along = float(k) / 64;
          uint32_t t = uint32_t(row * chart.columns + column);
          if (column + 1 < chart.columns)
            most = std::max(most, std::abs(at(t, 1, along) - at(t + 1, 0, along)));
          if (row + 1 < chart.rows)
            most = std::max(most,
                            std::abs(at(t, along, 1) - at(t + uint32_t(chart.columns), along, 0)));
        }
    return most;
  }
  // Mean jump at the middles of seams.
  float seam_jump() const {
    IlluminationMap map;
    map.tiles = tiles;
    for (vec3 l : light) map.nodes.light.push_back(pack_rgb9e5(l));
    float sum = 0;
    for (const ChartSeam& seam : charts.seams) {
      vec3 middle = 0.5f * (seam.from + seam.to);
      const auto& of = charts.places->charts;
      sum += std::abs(eval_illumination(map, of[seam.chart[0]], middle).x -
                      eval_illumination(map, of[seam.chart[1]], middle).x);
    }
    return sum / float(charts.seams.size());
  }
};

Mesh make_square() { return test::fan_mesh(0, {0, 0, 0}, {1, 0, 0}, {0, 0, -1}); }

TEST(FinishBake, TwoTilesAgreeWhereTheyMeet) {
  for (TileCells other : {TileCells{4, 4}, TileCells{8, 8}, TileCells{2, 16}, TileCells{16, 1}}) {
    Tiles t(test::fan_mesh(0, {0, 0, 0}, {2, 0, 0}, {0, 0, -1}), 1, [&](uint32_t tile) {
      return tile == 0 ? TileCells{4, 4} : other;
    });
    ASSERT_EQ(t.charts.tiles, 2u);
    EXPECT_GT(t.border_jump(), 0.2f);
    match_borders(t.charts, t.tiles, t.light);
    EXPECT_LT(t.border_jump(), 1e-5f) << int(other.columns) << " x " << int(other.rows);
  }
}

// Nothing within a tile changes, and what agrees stays as it is.
TEST(FinishBake, OnlyBordersAreMatched) {
  Tiles t(make_square(), 0.5f, [](uint32_t) { return TileCells{4, 4}; });
  const std::vector<vec3> before = t.light;
  match_borders(t.charts, t.tiles, t.light);
  for (const IlluminationTile& tile : t.tiles)
    for (uint32_t k : {6u, 7u, 8u, 11u, 12u, 13u, 16u, 17u, 18u})
      EXPECT_EQ(t.light[tile.first + k], before[tile.first + k]);
  t.light.assign(t.light.size(), vec3(0.25f));
  match_borders(t.charts, t.tiles, t.light);
  for (vec3 light : t.light) EXPECT_NEAR(light.x, 0.25f, 1e-6f);
}

TEST(FinishBake, WhereManyTilesMeetTheyAgreeAlmost) {
  for (bool equal : {true, false}) {
    Tiles t(make_square(), 0.25f, [&](uint32_t tile) {
      uint8_t cells = equal ? 4 : uint8_t(1 << (mix64(tile) % 4));
      return TileCells{cells, cells};
    });
    ASSERT_EQ(t.charts.tiles, 16u);
    float before = t.border_jump();
    match_borders(t.charts, t.tiles, t.light);
    EXPECT_LT(t.border_jump(), 0.1f * before) << equal;
  }
}

TEST(FinishBake, SmoothSeamsHardlyJump) {
  for (const Mesh& mesh : {sphere_mesh(0, 1, 16), test::tube_mesh(0, 1, 2, 48)}) {
    Tiles t(mesh, 0.5f, [](uint32_t) { return TileCells{4, 4}; });
    ASSERT_GT(t.charts.seams.size(), 4u);
    // Each chart has light of its own.
    std::vector<TilePlace> places = tile_places(t.charts);
    for (size_t tile = 0; tile < t.tiles.size(); tile++)
      for (uint32_t i = 0; i < t.tiles[tile].nodes(); i++)
        t.light[t.tiles[tile].first + i] = vec3(0.5f + 0.5f * float(places[tile].chart % 3));
    const float before = t.seam_jump();
    EXPECT_GT(before, 0.3f);
    for (int round = 0; round < 2; round++) {
      match_seams(t.charts, t.tiles, t.light);
      match_borders(t.charts, t.tiles, t.light);
    }
    EXPECT_LT(t.seam_jump(), 0.2f * before);
    for (vec3 light : t.light) EXPECT_TRUE(is_finite(light));
  }
}

TEST(FinishBake, CreasesAreLeftAlone) {
  Tiles t(box_mesh(0, vec3(1)), 0.5f, [](uint32_t) { return TileCells{4, 4}; });
  EXPECT_TRUE(t.charts.seams.empty());
  const std::vector<vec3> before = t.light;
  match_seams(t.charts, t.tiles, t.light);
  EXPECT_EQ(t.light, before);
}

TEST(FinishBake, HolesAreFilledFromTheirNeighbours) {
  Tiles t(make_square(), 0.5f, [](uint32_t) { return TileCells{8, 8}; });
  std::vector<TileCells> cells(4, TileCells{8, 8});
  BakeField field = make_field(t.world, t.charts, cells, 2);
  for (size_t i = 0; i < field.nodes(); i++) {
    uint32_t column = uint32_t(i % 9), row = uint32_t(i % 81 / 9);
    bool hole = (column > 1 && column < 6 && row > 2) || i >= 3 * 81;
    field.count[i] = hole ? 0 : 4;
    field.light_of(i)[0] = hole ? vec3(0) : vec3(4, 8, float(4 * column));
    field.light_of(i)[1] = hole ? vec3(0) : vec3(1);
  }
  std::vector<vec3> first = layer_means(field, field.light, 0),
                    second = layer_means(field, field.light, 1);
  for (size_t i = 0; i < field.nodes(); i++) {
    const bool unknown = i >= 3 * 81;  // a whole tile
    EXPECT_EQ(vec2(first[i]), unknown ? vec2(0) : vec2(1, 2)) << i;
    EXPECT_EQ(second[i], vec3(unknown ? 0.0f : 0.25f)) << i;
    if (!unknown) EXPECT_NEAR(first[i].z, float(i % 9), 3) << i;
  }
}

TEST(FinishBake, CoarseLightIsAddedInBetween) {
  Tiles coarse(make_square(), 0.5f, [](uint32_t) { return TileCells{1, 2}; });
  Tiles fine(make_square(), 0.5f, [](uint32_t) { return TileCells{4, 8}; });
  std::vector<vec3> sum = fine.light;
  add_coarser(coarse.tiles, coarse.light, fine.tiles, sum);
  for (uint32_t t = 0; t < 4; t++)
    for (uint32_t i = 0; i < fine.tiles[t].nodes(); i++) {
      size_t node = fine.tiles[t].first + i;
      float u = float(i % 5) / 4, v = float(i / 5) / 8;
      EXPECT_NEAR(sum[node].x - fine.light[node].x, coarse.at(t, u, v), 1e-5f);
    }
}

}  // namespace
}  // namespace wellspring::test
