// SPDX-License-Identifier: Apache-2.0
// Nodes of a bake, in the tiles of its charts, and what samples around them have found. A node
// stands for the surface within half a cell of it: its samples are spread over that.
#pragma once
#include <span>
#include <vector>

#include "light/bake/charts.h"

namespace wellspring::light {

// A triangle's part of what a node stands for.
struct NodeSupport {
  uint32_t triangle = 0;  // of the chart's instance
  float area = 0;         // in cells
};

inline constexpr uint32_t no_normal = 0;  // which pack_node_normal() never gives

struct BakeField {
  std::vector<IlluminationTile> tiles;
  std::vector<uint32_t> first_support;  // of each node, and the end
  std::vector<NodeSupport> supports;
  int layers = 1;
  std::vector<vec3> light;           // sums: of each node, each layer's
  std::vector<vec3> slope;           // likewise, luminance times slope_of(); empty: not wanted
  std::vector<uint32_t> normal;      // of each node: node_normals(); empty where slopes are
  std::vector<float> squares;        // of each node: of the luminance of all layers
  std::vector<float> count, hidden;  // samples that count, and those within something solid
  std::vector<uint32_t> asked;       // of each tile: samples of each of its nodes
  size_t nodes() const { return count.size(); }
  // Luminance of all layers: the mean of a node's samples, of which there must be some, and the
  // variance of one sample.
  double mean_of(size_t node) const;
  double variance_of(size_t node) const;
  // Unit; 0 where each place has its own.
  vec3 normal_of(size_t node) const {
    return normal.empty() || normal[node] == no_normal
               ? vec3(0)
               : normalize(unpack_node_normal(normal[node]));
  }
  vec3* slope_of(size_t node) { return slope.empty() ? nullptr : &slope[node * size_t(layers)]; }
  vec3* light_of(size_t node) { return &light[node * size_t(layers)]; }
  const vec3* light_of(size_t node) const { return &light[node * size_t(layers)]; }
};
size_t memory_bytes(const BakeField& field);
// What a tile's samples have found, into a tile of as many nodes.
void copy_tile(const BakeField& from, uint32_t from_tile, BakeField& to, uint32_t to_tile);

// Forgets what samples have found, but not how many were asked: the next ones are others.
void clear_samples(BakeField& field);

// How many cells a tile has along its sides, powers of two; 0: nothing of the surface is in it.
struct TileCells {
  uint8_t columns = 0, rows = 0;
};
inline constexpr int most_cells_a_tile = 64;

// Which tiles hold some of their chart: one cell each.
std::vector<TileCells> find_occupied(const World& world, const BakeCharts& charts);
// The largest cells of which there are no more than about `nodes` nodes. Cells are as large as they
// look from the nearest of `places` (scene coordinates); without any as large as each other.
std::vector<TileCells> choose_cells(const World& world, const BakeCharts& charts,
                                    std::span<const vec3> places, size_t nodes);
size_t node_count(std::span<const TileCells> cells);
std::vector<TileCells> cells_of(const BakeField& field);

BakeField make_field(const World& world, const BakeCharts& charts, std::span<const TileCells> cells,
                     int layers);
// The mean of the mesh's normals over what each node stands for, pack_node_normal(), on the side
// that the chart shows; no_normal of nodes that stand for nothing, and where a chart is not bent.
std::vector<uint32_t> node_normals(const World& world, const BakeCharts& charts,
                                   std::span<const IlluminationTile> tiles, size_t nodes);

// The chart of each tile, and where it is in it.
struct TilePlace {
  uint32_t chart = 0;
  int column = 0, row = 0;
};
std::vector<TilePlace> tile_places(const BakeCharts& charts);

// A place in what a node stands for.
struct NodePlace {
  bool valid = false;
  Hit hit;
  Ray ray;  // towards it, from its lit side
};
NodePlace sample_node(const World& world, const BakeCharts& charts, const BakeField& field,
                      const TilePlace& at, uint32_t tile, uint32_t node_of_tile, float choice,
                      vec2 u);

}  // namespace wellspring::light
