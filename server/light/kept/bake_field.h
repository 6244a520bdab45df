// SPDX-License-Identifier: Apache-2.0
// Keeps the nodes of a bake, in the tiles of its charts, and what samples around them have found. A
// node stands for the surface within half a cell around it: its samples are spread over that part.
#pragma once
#include <span>
#include <vector>

#include "light/kept/charts.h"

namespace wellspring::light {

// Holds a triangle's part of a node's surface.
struct NodeSupport {
  uint32_t triangle = 0;  // index in the chart's instance
  float area = 0;         // cells of the tile
};

inline constexpr uint32_t no_normal = 0;  // a value that pack_node_normal() never returns

struct BakeField {
  std::vector<IlluminationTile> tiles;
  std::vector<uint32_t> first_support;  // index in `supports` for each node, and the end
  std::vector<NodeSupport> supports;
  int layers = 1;
  std::vector<vec3> light;           // sums of samples, for each node and layer
  std::vector<vec3> slope;           // likewise, of luminance times slope_of(); empty: not wanted
  std::vector<uint32_t> normal;      // node_normals(); empty if `slope` is empty
  std::vector<float> squares;        // sums of each node's squared luminance of all layers
  std::vector<float> count, hidden;  // samples that count; samples covered, or within a solid
  std::vector<uint32_t> asked;       // samples of each of a tile's nodes, for each tile
  size_t nodes() const { return count.size(); }
  // Return figures for the luminance of all layers: the mean of a node's samples, of which there
  // must be some, and the variance of one sample.
  double mean_of(size_t node) const;
  double variance_of(size_t node) const;
  // Returns a unit normal; 0 if each place has its own.
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
// Copies what a tile's samples have found into a tile of as many nodes.
void copy_tile(const BakeField& from, uint32_t from_tile, BakeField& to, uint32_t to_tile);

// Clears what samples have found, but not how many were asked for: the next samples are new ones.
void clear_samples(BakeField& field);

// Holds the numbers of cells along a tile's sides, powers of two; 0: nothing of the surface is in
// the tile.
struct TileCells {
  uint8_t columns = 0, rows = 0;
};
inline constexpr int most_cells_a_tile = 64;

// Returns one cell for each tile that holds some of its chart, none for the others.
std::vector<TileCells> find_occupied(const World& world, const BakeCharts& charts);
// Returns the smallest cells of which there are no more than about `nodes` nodes. All cells look
// equally large from the nearest of `places` (scene coordinates); without any they are equally
// large.
std::vector<TileCells> choose_cells(const World& world, const BakeCharts& charts,
                                    std::span<const vec3> places, size_t nodes);
size_t node_count(std::span<const TileCells> cells);
std::vector<TileCells> cells_of(const BakeField& field);

BakeField make_field(const World& world, const BakeCharts& charts, std::span<const TileCells> cells,
                     int layers);
// Returns the mean of the mesh's normals over each node's surface, as pack_node_normal(), on the
// side that the chart shows; no_normal for nodes without surface, and for charts that are not bent.
std::vector<uint32_t> node_normals(const World& world, const BakeCharts& charts,
                                   std::span<const IlluminationTile> tiles, size_t nodes);

// Holds the chart of a tile, and the tile's place in it.
struct TilePlace {
  uint32_t chart = 0;
  int column = 0, row = 0;
};
std::vector<TilePlace> tile_places(const BakeCharts& charts);

// Holds a place of a node's surface.
struct NodePlace {
  bool valid = false;
  Hit hit;
  Ray ray;  // towards the place, from its lit side
};
NodePlace sample_node(const World& world, const BakeCharts& charts, const BakeField& field,
                      const TilePlace& at, uint32_t tile, uint32_t node_of_tile, float choice,
                      vec2 u);

}  // namespace wellspring::light
