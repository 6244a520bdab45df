// SPDX-License-Identifier: Apache-2.0
// Makes charts of what stands still and scatters light diffusely: connected triangles of an
// instance that face about the same way, found by growing from the largest. Each chart is projected
// along the normal of its first triangle, so lengths shrink by the cosine to it at most.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/material/material_use.h"
#include "light/sample/illumination_map.h"

namespace wellspring::light {

// Holds the triangles of a chart, and the side from which light is baked.
struct ChartSurface {
  uint32_t instance = 0;
  bool back = false;              // whether it is seen from behind its winding
  vec3 normal{0};                 // direction of projection, unit, towards the viewer
  uint32_t first = 0, count = 0;  // in BakeCharts::triangles
};

// A seam is an edge that two charts share on a smooth surface: light must not jump there.
struct ChartSeam {
  uint32_t chart[2] = {0, 0};
  vec3 from{0}, to{0};
  // The mesh's normals at both ends, unit, on the charts' side.
  vec3 normal[2] = {vec3(0), vec3(0)};
};

struct BakeCharts {
  std::shared_ptr<IlluminationCharts> places;
  std::vector<ChartSurface> surfaces;  // one for each chart
  std::vector<uint32_t> triangles;     // chart after chart
  std::vector<ChartSeam> seams;
  uint32_t tiles = 0;   // tiles of all charts
  bool sloped = false;  // whether some chart is sloped
  double area = 0;      // area of all their triangles, square metres
  size_t vertices = 0;  // vertices that storage at vertices would have, for comparison
};

// Returns whether a material's light is kept: it is opaque but for its alpha, and some of it
// scatters diffusely: it is neither black nor a metal all over.
bool keeps_illumination(const Material& material, TextureRanges& ranges);

// Makes the charts of a scene, a function of the scene alone. `tile`: metres; the sides of a chart
// are cut into equal parts of at most that. Two-sided materials have charts for either side.
BakeCharts make_charts(const World& world, float tile);
// Returns the sum of the areas of all triangles that have a chart, square metres.
double charted_area(const World& world);

}  // namespace wellspring::light
