// SPDX-License-Identifier: Apache-2.0
#include "light/kept/bake_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "unit/light/kept/bake_cases.h"
#include "world/surface.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// One surface, its charts, and a field of as many cells along each side of a tile.
struct Field {
  Scene scene;
  World world;
  BakeCharts charts;
  BakeField field;
  std::vector<TilePlace> places;
  Field(Scene made, float tile, uint8_t cells)
      : scene(std::move(made)), world(scene), charts(make_charts(world, tile)) {
    std::vector<TileCells> chosen = find_occupied(world, charts);
    for (TileCells& c : chosen)
      if (c.columns > 0) c = {cells, cells};
    field = make_field(world, charts, chosen, 1);
    places = tile_places(charts);
  }
  float support(size_t node) const {
    float sum = 0;
    for (uint32_t i = field.first_support[node]; i < field.first_support[node + 1]; i++)
      sum += field.supports[i].area;
    return sum;
  }
  const IlluminationChart& chart(uint32_t tile) const {
    return charts.places->charts[places[tile].chart];
  }
};

Scene make_square(bool fan, bool double_sided = false) {
  Scene scene = empty_scene();
  Material material = diffuse(vec3(0.5f));
  material.double_sided = double_sided;
  int m = add_material(scene, material);
  if (fan) add_fan(scene, m, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  else add_quad(scene, m, {0, 0, 0}, {1, 0, 0}, {0, 0, -1});
  return scene;
}

TEST(BakeField, NodesOfASquareStandForACellOrHalfOrAQuarter) {
  Field f(make_square(true), 0.5f, 4);
  ASSERT_EQ(f.charts.tiles, 4u);
  for (uint32_t t = 0; t < 4; t++)
    for (uint32_t i = 0; i < f.field.tiles[t].nodes(); i++) {
      vec3 place = node_place(f.chart(t), f.places[t], f.field.tiles[t], i);
      float expected = 1;
      for (float x : {place.x, -place.z})
        if (x < 1e-4f || x > 1 - 1e-4f) expected *= 0.5f;
      EXPECT_NEAR(f.support(f.field.tiles[t].first + i), expected, 1e-4) << t << ", node " << i;
    }
}

// The chart lies askew: the surface within half a cell of the node is counted on a fine grid.
TEST(BakeField, NodesStandForTheSurfaceInTheirBoxes) {
  Field f(make_square(false), 0.4f, 2);
  int partial = 0;
  for (uint32_t t = 0; t < f.charts.tiles; t++) {
    const IlluminationTile& tile = f.field.tiles[t];
    const IlluminationChart& chart = f.chart(t);
    vec3 u = chart.along_u / dot(chart.along_u, chart.along_u) / float(tile.columns),
         v = chart.along_v / dot(chart.along_v, chart.along_v) / float(tile.rows);
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      vec3 place = node_place(chart, f.places[t], tile, i);
      float inside = 0;
      constexpr int fine = 40;
      for (int k = 0; k < fine * fine; k++) {
        vec2 at = (vec2(float(k % fine), float(k / fine)) + 0.5f) / float(fine) - 0.5f;
        vec3 p = place + at.x * u + at.y * v;
        inside += p.x >= 0 && p.x <= 1 && p.z <= 0 && p.z >= -1;
      }
      inside /= fine * fine;
      partial += inside > 0.1f && inside < 0.9f;
      EXPECT_NEAR(f.support(tile.first + i), inside, 0.04) << t << ", node " << i;
    }
  }
  EXPECT_GT(partial, 10);
}

TEST(BakeField, PlacesLieInWhatTheirNodeStandsForAndOnItsSide) {
  Field f(make_square(false, true), 0.4f, 2);
  uint64_t random = 1;
  auto next = [&] { return float(mix64(random++) >> 40) * (1.0f / (1 << 24)); };
  for (uint32_t t = 0; t < f.charts.tiles; t++) {
    const IlluminationTile& tile = f.field.tiles[t];
    const IlluminationChart& chart = f.chart(t);
    for (uint32_t i = 0; i < tile.nodes(); i++)
      for (int k = 0; k < 16; k++) {
        NodePlace place =
            sample_node(f.world, f.charts, f.field, f.places[t], t, i, next(), {next(), next()});
        ASSERT_EQ(place.valid, f.support(tile.first + i) > 0);
        if (!place.valid) continue;
        vec3 at = eval_position(f.world, 0, place.hit.triangle, place.hit.barycentric);
        EXPECT_LT(length(place.ray.origin + place.hit.t * place.ray.direction - at), 1e-5f);
        vec3 away = at - node_place(chart, f.places[t], tile, i);
        EXPECT_LT(std::abs(dot(away, chart.along_u)) * float(tile.columns), 0.501f);
        EXPECT_LT(std::abs(dot(away, chart.along_v)) * float(tile.rows), 0.501f);
        EXPECT_LT(dot(place.ray.direction, f.charts.surfaces[f.places[t].chart].normal), -0.99f);
      }
  }
}

// As many places lie in one half of the square as there is surface of that half in the node's box,
// within five standard errors and the error of counting.
TEST(BakeField, PlacesAreSpreadEvenly) {
  Field f(make_square(false), 1, 1);
  const IlluminationTile& tile = f.field.tiles[0];
  const IlluminationChart& chart = f.chart(0);
  const vec3 u = chart.along_u / dot(chart.along_u, chart.along_u),
             v = chart.along_v / dot(chart.along_v, chart.along_v);
  constexpr int count = 4096, fine = 200;
  for (uint32_t i = 0; i < tile.nodes(); i++) {
    const vec3 node = node_place(chart, f.places[0], tile, i);
    int there = 0, all = 0;
    for (int k = 0; k < fine * fine; k++) {
      vec2 at = (vec2(float(k % fine), float(k / fine)) + 0.5f) / float(fine) - 0.5f;
      vec3 p = node + at.x * u + at.y * v;
      if (p.x < 0 || p.x > 1 || p.z > 0 || p.z < -1) continue;
      all++, there += p.x < 0.5f;
    }
    if (all == 0) continue;
    auto next = [&, random = uint64_t(0)]() mutable {
      return float(mix64(random++) >> 40) * (1.0f / (1 << 24));
    };
    int hits = 0;
    for (int k = 0; k < count; k++) {
      float choice = next(), x = next(), y = next();
      NodePlace place = sample_node(f.world, f.charts, f.field, f.places[0], 0, i, choice, {x, y});
      ASSERT_TRUE(place.valid);
      hits += eval_position(f.world, 0, place.hit.triangle, place.hit.barycentric).x < 0.5f;
    }
    EXPECT_NEAR(double(hits) / count, double(there) / all, 5 * 0.5 / std::sqrt(count) + 0.01) << i;
  }
}

TEST(BakeField, CellsKeepToTheNumberOfNodes) {
  for (bool fan : {true, false}) {
    Scene scene = make_square(fan);
    World world(scene);
    BakeCharts charts = make_charts(world, 0.25f);
    const size_t least = node_count(find_occupied(world, charts));
    for (size_t nodes : {200, 400, 1000, 3000, 10000, 30000}) {
      size_t count = node_count(choose_cells(world, charts, {}, nodes));
      EXPECT_LE(count, std::max(nodes, least)) << nodes;
      EXPECT_GE(count, std::min(nodes / 5, size_t(1000))) << nodes;
    }
  }
}

TEST(BakeField, NearerTilesAreNotCoarser) {
  Scene scene = empty_scene();
  add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {0, 0, 0}, {8, 0, 0}, {0, 0, -8});
  World world(scene);
  BakeCharts charts = make_charts(world, 0.5f);
  const vec3 eye(1, 1.5f, -1);
  std::vector<TileCells> cells = choose_cells(world, charts, std::span(&eye, 1), 8000);
  EXPECT_LE(node_count(cells), 8000u);
  std::vector<TilePlace> places = tile_places(charts);
  std::vector<std::pair<float, int>> sorted;
  for (size_t t = 0; t < cells.size(); t++) {
    const IlluminationChart& chart = charts.places->charts[places[t].chart];
    IlluminationTile one{0, 2, 2};  // its middle is node 4
    sorted.push_back({length(node_place(chart, places[t], one, 4) - eye), cells[t].columns});
  }
  std::sort(sorted.begin(), sorted.end());
  EXPECT_GT(sorted.front().second, sorted.back().second);
  for (size_t i = 1; i < sorted.size(); i++)
    if (sorted[i].first > sorted[i - 1].first + 1e-4f)
      EXPECT_LE(sorted[i].second, sorted[i - 1].second) << sorted[i].first;
}

}  // namespace
}  // namespace wellspring::test
