// SPDX-License-Identifier: Apache-2.0
// Illumination maps: the diffuse light that falls on what stands still, baked once, kept in charts
// (Haber, Myszkowski, Yamauchi, Seidel 2001, "Perceptually Guided Corrective Splatting", sections 1
// and 4.1; mesh-to-texture). A chart is a connected part of a surface that faces about one way,
// projected along that direction and cut into tiles; light is kept at the nodes of a grid in each
// tile and is bilinear in between. Frozen once made.
//
// On charts whose normals differ light is kept as it falls on the mean of those around each node,
// with a slope that turns it to each place's normal (light/material/light_slope.h).
//
// What is kept is Sample::smooth of a Lambertian surface under all light of the scene, punctual
// light too: irradiance over pi. A coat's darkening towards the viewer is not in it.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "base/rgb9e5.h"
#include "light/material/light_slope.h"
#include "world/world.h"

namespace wellspring::light {

inline constexpr uint32_t no_chart = 0xffffffffu, no_tile = 0xffffffffu;

// Place p lies at (dot(p - origin, along_u), dot(p - origin, along_v)), counted in tiles.
struct IlluminationChart {
  vec3 origin{0}, along_u{0}, along_v{0};
  uint32_t first_tile = 0;  // row by row
  int columns = 1, rows = 1;
  // Its mesh's normals differ: light and slope of a node are relative to the node's own normal.
  bool bent = false;
  bool sloped = false;  // bent, or its material has a map of normals: slopes are kept
};

// A grid of (columns + 1) x (rows + 1) nodes, row by row.
struct IlluminationTile {
  uint32_t first = no_tile;  // node; no_tile: nothing of the surface is here
  uint16_t columns = 1, rows = 1;
  uint32_t nodes() const { return first == no_tile ? 0u : (columns + 1u) * (rows + 1u); }
};

// Where charts lie: shared by all maps of a bake.
struct IlluminationCharts {
  float tile = 0;  // metres: sides of charts are cut into parts of at most that
  std::vector<uint32_t> first_triangle;  // of instance * 2 + (1: seen from the back) in chart_of
  std::vector<uint32_t> chart_of;        // of each triangle of those; or no_chart
  std::vector<IlluminationChart> charts;
  // The chart of a triangle as seen from one side, or no_chart.
  uint32_t find(uint32_t instance, uint32_t triangle, bool front) const {
    size_t side = size_t(instance) * 2 + (front ? 0 : 1);
    if (side >= first_triangle.size() || first_triangle[side] == no_chart) return no_chart;
    return chart_of[first_triangle[side] + triangle];
  }
};

// Every node keeps these.
struct IlluminationNodes {
  std::vector<uint32_t> light;  // pack_rgb9e5()
  std::vector<uint32_t> slope;  // pack_slope(); empty where no material has a use for it
};

struct IlluminationMap {
  std::shared_ptr<const IlluminationCharts> places;
  std::vector<IlluminationTile> tiles;
  IlluminationNodes nodes;  // of the lamps as they are
  // The mean of the mesh's normals around each node, pack_node_normal(); null where no slopes are
  // kept.
  std::shared_ptr<const std::vector<uint32_t>> normals;
  // The light of what belongs to no lamp, then of each lamp alone. Copies share them.
  std::shared_ptr<const std::vector<IlluminationNodes>> layers;
  float error = 1;  // estimated: root mean square of what it is wrong by over the mean light
  float mean = 0;   // luminance of the mean light
  float usual = 0;  // geometric mean of the luminance, of the lamps as they are
  float least_known() const { return mean > 0 ? 0.01f * mean : 1.0f; }  // see known_light()
};
// Light of a map that may be wrong by more waits for what visitors' own samples say.
inline constexpr float most_sure_error = 0.5f;
size_t memory_bytes(const IlluminationMap& map);
// Of a scene's map: one for each lamp, and one for what belongs to none.
inline size_t layer_count(const Scene& scene) { return scene.lamps.size() + 1; }

// Gives a map of layers alone its nodes, of all lamps full, and their mean.
IlluminationMap sum_of_layers(IlluminationMap map);

// Its light where lamp i is as bright as levels[i]. Milliseconds.
std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all,
                                             std::span<const LampLevel> levels);

// Of each of the scene's objects: whether the map knows the light of any part of it.
std::vector<char> mapped_objects(const Scene& scene, const IlluminationMap& map);

// The tile that a place of a chart lies in, and where in it, 0 to 1; null: nothing of the surface
// is there. A place beside the chart by rounding is taken for its edge.
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

// The four nodes around a place of a chart (scene coordinates), and how much each counts; of
// weight 0 where nothing of the surface is.
struct IlluminationTaps {
  uint32_t node[4] = {0, 0, 0, 0};
  float weight[4] = {0, 0, 0, 0};
};
IlluminationTaps find_taps(const IlluminationMap& map, const IlluminationChart& chart, vec3 place);
vec3 eval_illumination(const IlluminationNodes& nodes, const IlluminationTaps& taps);
vec3 eval_illumination_slope(const IlluminationNodes& nodes, const IlluminationTaps& taps);
// The normal that both are relative to, not quite unit: the nodes' own where the chart is bent,
// else `mesh`, the mesh's normal at the place.
vec3 eval_illumination_normal(const IlluminationMap& map, const IlluminationChart& chart,
                              const IlluminationTaps& taps, vec3 mesh);
// Times as much light as `nodes` have at a place of the chart falls on a surface there that faces
// along `seen`, of a mesh whose normal is `mesh`; both unit.
float eval_illumination_turn(const IlluminationMap& map, const IlluminationNodes& nodes,
                             const IlluminationChart& chart, const IlluminationTaps& taps,
                             vec3 mesh, vec3 seen);

// The nodes' light at a place of a chart: scene coordinates, or in tiles as IlluminationChart has
// them.
vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec3 place);
vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec2 at);

// What Sample::known is of light that a map gives: a little more (Sample::raised), so that no ratio
// to it is without bounds.
inline vec3 known_light(const IlluminationMap& map, vec3 light) {
  return light + vec3(map.least_known());
}

}  // namespace wellspring::light
