// SPDX-License-Identifier: Apache-2.0
// Small scenes to bake, bakes of a few hundred nodes, and maps whose light is written down.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include "light/kept/bake_file.h"
#include "light/kept/finish_bake.h"
#include "scenes/scenes.h"

namespace wellspring::test {

// Bakes until so many passes are done.
inline void bake_passes(const BakeScene& scene, Bake& bake, uint64_t passes) {
  if (passes > 0) go_on(scene, bake, [&] { return bake.passes >= passes; });
}

}  // namespace wellspring::test

namespace wellspring::test {

// A rectangle of four triangles around its middle, so that its chart lies along its sides.
inline Mesh fan_mesh(int material, vec3 corner, vec3 u, vec3 v) {
  Mesh mesh;
  mesh.material = material;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v, corner + 0.5f * (u + v)};
  mesh.normals.assign(5, normalize(cross(u, v)));
  mesh.uv[0].assign(5, vec2(0));
  for (uint32_t i = 0; i < 4; i++) mesh.triangles.push_back({i, (i + 1) % 4, 4});
  return mesh;
}
inline int add_fan(Scene& scene, int material, vec3 corner, vec3 u, vec3 v) {
  return scenes::add_mesh(scene, fan_mesh(material, corner, u, v), "fan");
}

// An open tube along y with smooth normals.
inline Mesh tube_mesh(int material, float radius, float height, int columns) {
  Mesh mesh;
  mesh.material = material;
  for (int x = 0; x <= columns; x++)
    for (float y : {0.0f, height}) {
      float phi = 2 * pi * float(x % columns) / float(columns);
      vec3 normal(std::cos(phi), 0, -std::sin(phi));
      mesh.positions.push_back(radius * normal + vec3(0, y, 0));
      mesh.normals.push_back(normal);
    }
  for (uint32_t x = 0; x < uint32_t(columns); x++) {
    mesh.triangles.push_back({2 * x, 2 * x + 2, 2 * x + 1});
    mesh.triangles.push_back({2 * x + 1, 2 * x + 2, 2 * x + 3});
  }
  return mesh;
}

inline PunctualLight point_light(vec3 place, vec3 intensity) {
  PunctualLight light;
  light.position = place;
  light.intensity = intensity;
  return light;
}

// A scene and a bake of it by paths.
struct Baked {
  Scene scene;
  World world;
  BakeScene lit;
  Bake bake;
  explicit Baked(Scene made,
                 const BakeSettings& settings = {.gather_nodes = 400, .direct_nodes = 1200})
      : scene(std::move(made)),
        world(scene),
        lit(make_bake_scene_of_paths(world)),
        bake(begin_bake(world, {}, settings)) {}
  std::shared_ptr<const IlluminationMap> map(uint64_t passes) {
    bake_passes(lit, bake, passes);
    return finish_map(bake);
  }
};

inline bool same_bits(const BakeField& a, const BakeField& b) {
  auto alike = [](const IlluminationTile& x, const IlluminationTile& y) {
    return x.first == y.first && x.columns == y.columns && x.rows == y.rows;
  };
  return std::equal(a.tiles.begin(), a.tiles.end(), b.tiles.begin(), b.tiles.end(), alike) &&
         a.layers == b.layers && a.light == b.light && a.squares == b.squares &&
         a.count == b.count && a.hidden == b.hidden && a.asked == b.asked;
}
inline bool same_bits(const Bake& a, const Bake& b) {
  return same_bits(a.direct, b.direct) && same_bits(a.gather, b.gather) && a.passes == b.passes &&
         a.refined == b.refined && a.cursor == b.cursor;
}

// Returns where node `i` of a tile lies on its chart's plane.
inline vec3 node_place(const IlluminationChart& chart, const TilePlace& at,
                       const IlluminationTile& tile, uint32_t i) {
  float u = float(at.column) + float(i % (tile.columns + 1u)) / float(tile.columns),
        v = float(at.row) + float(i / (tile.columns + 1u)) / float(tile.rows);
  return chart.origin + u * chart.along_u / dot(chart.along_u, chart.along_u) +
         v * chart.along_v / dot(chart.along_v, chart.along_v);
}

// A map of cells of about `cell` metres: first the light of no lamp, then of each lamp alone.
using PaintedLight = std::function<vec3(vec3 place)>;
inline std::shared_ptr<const IlluminationMap> paint_map(const World& world, float cell,
                                                        const std::vector<PaintedLight>& layers) {
  BakeCharts charts = make_charts(world, 4 * cell);
  std::vector<TileCells> cells = find_occupied(world, charts);
  for (TileCells& c : cells)
    if (c.columns > 0) c = {4, 4};
  auto map = std::make_shared<IlluminationMap>();
  map->places = charts.places;
  map->tiles = make_field(world, charts, cells, 1).tiles;
  IlluminationNodes dark;
  dark.light.resize(node_count(cells));
  auto parts = std::make_shared<std::vector<IlluminationNodes>>(layers.size(), dark);
  const std::vector<TilePlace> places = tile_places(charts);
  for (size_t t = 0; t < cells.size(); t++)
    for (uint32_t i = 0; i < map->tiles[t].nodes(); i++) {
      vec3 place = node_place(charts.places->charts[places[t].chart], places[t], map->tiles[t], i);
      for (size_t l = 0; l < layers.size(); l++)
        (*parts)[l].light[map->tiles[t].first + i] = pack_rgb9e5(layers[l](place));
    }
  map->error = 0.01f;
  map->layers = parts;
  return std::make_shared<IlluminationMap>(sum_of_layers(std::move(*map)));
}

}  // namespace wellspring::test
