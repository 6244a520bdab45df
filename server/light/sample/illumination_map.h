// SPDX-License-Identifier: Apache-2.0
// Keeps illumination maps: the diffuse light that falls on what stands still, baked once, kept in
// charts (Haber, Myszkowski, Yamauchi, Seidel 2001, "Perceptually Guided Corrective Splatting",
// sections 1 and 4.1; mesh-to-texture). A chart is a connected part of a surface that faces about
// one way, projected along that direction and cut into tiles; light is kept at the nodes of a grid
// in each tile and is bilinear in between. A map never changes once it is made.
//
// On charts whose normals differ, light is kept as it falls on the mean of the normals around each
// node, with a slope that turns it to each place's normal (light/material/light_slope.h).
//
// A node keeps Sample::smooth of a Lambertian surface under all light of the scene, punctual light
// too: irradiance over pi. A coat's darkening towards the viewer is not in it.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/rgb9e5.h"
#include "light/material/light_slope.h"
#include "world/world.h"

namespace wellspring::light {

inline constexpr uint32_t no_chart = 0xffffffffu, no_tile = 0xffffffffu;

// A chart places p at (dot(p - origin, along_u), dot(p - origin, along_v)), counted in tiles.
struct IlluminationChart {
  vec3 origin{0}, along_u{0}, along_v{0};
  uint32_t first_tile = 0;  // index of its first tile; its tiles follow row by row
  int columns = 1, rows = 1;
  // Its mesh's normals differ: light and slope of a node are relative to the node's own normal.
  bool bent = false;
  bool sloped = false;   // bent, or its material has a map of normals: slopes are kept
  int reflectance = -1;  // MaterialSpectra::reflectance
};

// A tile is a grid of (columns + 1) x (rows + 1) nodes, row by row.
struct IlluminationTile {
  uint32_t first = no_tile;  // first node; no_tile: nothing of the surface is here
  uint16_t columns = 1, rows = 1;
  uint32_t nodes() const { return first == no_tile ? 0u : (columns + 1u) * (rows + 1u); }
};

// Holds where charts lie; all maps of a bake share it.
struct IlluminationCharts {
  float tile = 0;  // metres: sides of charts are cut into parts of at most that length
  // Index into chart_of, by instance * 2 + (1: seen from the back)
  std::vector<uint32_t> first_triangle;
  std::vector<uint32_t> chart_of;  // chart of each triangle, or no_chart
  std::vector<IlluminationChart> charts;
  // Returns the chart of a triangle as seen from one side, or no_chart.
  uint32_t find(uint32_t instance, uint32_t triangle, bool front) const {
    size_t side = size_t(instance) * 2 + (front ? 0 : 1);
    if (side >= first_triangle.size() || first_triangle[side] == no_chart) return no_chart;
    return chart_of[first_triangle[side] + triangle];
  }
};

// Holds what every node keeps.
struct IlluminationNodes {
  std::vector<uint32_t> light;  // pack_rgb9e5()
  std::vector<uint32_t> slope;  // pack_slope(); empty if no material has a use for it
};

struct IlluminationMap {
  std::shared_ptr<const IlluminationCharts> places;
  std::vector<IlluminationTile> tiles;
  IlluminationNodes nodes;  // light and slopes with the lamps as they are
  // Means of the mesh's normals around each node, pack_node_normal(); null if no slopes are kept.
  std::shared_ptr<const std::vector<uint32_t>> normals;
  // Nodes of the light that belongs to no lamp, then of each lamp alone: colours, or bins of
  // wavelengths (light/kept/binned_light.h). Copies share them.
  std::shared_ptr<const std::vector<IlluminationNodes>> layers;
  float error = 1;  // estimated error: its root mean square over the mean light
  float mean = 0;   // luminance of the mean light
  float usual = 0;  // geometric mean of the luminance, with the lamps as they are
  float least_known() const { return mean > 0 ? 0.01f * mean : 1.0f; }  // see known_light()
};
// If a map's error is greater, its light waits for visitors' own samples.
inline constexpr float most_sure_error = 0.5f;
size_t memory_bytes(const IlluminationMap& map);

// Holds what makes colours of the light in layers: a matrix for each layer, which the light is
// multiplied by (find_layer_colors() in light/kept/binned_light.h).
struct LayerColors {
  // At 0: on charts without a reflectance; at reflectance + 1: on charts with it. Empty: layers
  // hold colours.
  std::vector<std::vector<mat3>> of;
  const std::vector<mat3>& on(int reflectance) const { return of[size_t(reflectance + 1)]; }
};
// Gives a map that has only layers its nodes, and their mean. `colors`: with all lamps full.
IlluminationMap sum_of_layers(IlluminationMap map, const LayerColors& colors = {});
// Returns the map with other colours. Takes milliseconds.
std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all, const LayerColors& colors);

// Returns for each of the scene's objects whether the map has the light of any part of it.
std::vector<char> mapped_objects(const Scene& scene, const IlluminationMap& map);

// Holds the tile that a place of a chart lies in, and where in it, 0 to 1; null: nothing of the
// surface is there. A place beside the chart by rounding is taken for its edge.
struct PlaceInTile {
  const IlluminationTile* tile = nullptr;
  float u = 0, v = 0;
};
PlaceInTile find_tile(const IlluminationChart& chart, std::span<const IlluminationTile> tiles,
                      vec2 at);
inline vec2 place_in_chart(const IlluminationChart& chart, vec3 place) {
  vec3 to = place - chart.origin;
  return {dot(to, chart.along_u), dot(to, chart.along_v)};
}
inline PlaceInTile find_tile(const IlluminationChart& chart,
                             std::span<const IlluminationTile> tiles, vec3 place) {
  return find_tile(chart, tiles, place_in_chart(chart, place));
}

// Holds the four nodes around a place of a chart (scene coordinates), and their weights, which are
// 0 where nothing of the surface is.
struct IlluminationTaps {
  uint32_t node[4] = {0, 0, 0, 0};
  float weight[4] = {0, 0, 0, 0};
};
IlluminationTaps find_taps(const IlluminationMap& map, const IlluminationChart& chart, vec3 place);
vec3 eval_illumination(const IlluminationNodes& nodes, const IlluminationTaps& taps);
vec3 eval_illumination_slope(const IlluminationNodes& nodes, const IlluminationTaps& taps);
// Returns the normal that light and slope are relative to, not quite unit: the nodes' own if the
// chart is bent, else `mesh`, the mesh's normal at the place.
vec3 eval_illumination_normal(const IlluminationMap& map, const IlluminationChart& chart,
                              const IlluminationTaps& taps, vec3 mesh);
// Returns the factor from the light of `nodes` at a place of the chart to the light that falls on a
// surface there that faces along `seen`, of a mesh whose normal is `mesh`; both unit.
float eval_illumination_turn(const IlluminationMap& map, const IlluminationNodes& nodes,
                             const IlluminationChart& chart, const IlluminationTaps& taps,
                             vec3 mesh, vec3 seen);

// Return the nodes' light at a place of a chart: in scene coordinates, or in tiles as
// IlluminationChart has them.
vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec3 place);
vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec2 at);

// Returns Sample::known for light of a map: a little more than it (Sample::raised), so that no
// ratio to it is without bounds.
inline vec3 known_light(const IlluminationMap& map, vec3 light) {
  return light + vec3(map.least_known());
}

}  // namespace wellspring::light
