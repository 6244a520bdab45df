// SPDX-License-Identifier: Apache-2.0
// Charts of what stands still and scatters light diffusely: connected triangles of an instance that
// face about the same way, found by growing from the largest. Each is projected along the normal of
// its first triangle, so lengths shrink by the cosine to it at most.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/sample/illumination_map.h"
#include "light/transport_plan.h"

namespace wellspring::light {

// Of a chart: what bakes it.
struct ChartSurface {
  uint32_t instance = 0;
  bool back = false;              // seen from behind its winding
  vec3 normal{0};                 // that it is projected along, towards who sees it
  uint32_t first = 0, count = 0;  // in BakeCharts::triangles
};

// An edge that two charts share where the surface is smooth: light must not jump there.
struct ChartSeam {
  uint32_t chart[2] = {0, 0};
  vec3 from{0}, to{0};
  vec3 normal[2] = {vec3(0), vec3(0)};  // of the mesh at both ends, unit, on the charts' side
};

struct BakeCharts {
  std::shared_ptr<IlluminationCharts> places;
  std::vector<ChartSurface> surfaces;  // of each chart
  std::vector<uint32_t> triangles;     // chart after chart
  std::vector<ChartSeam> seams;
  uint32_t tiles = 0;   // of all charts
  bool sloped = false;  // some chart is
  double area = 0;      // square metres of all their triangles
  size_t vertices = 0;  // that storage at vertices would have, for comparison
};

// Whether a material's light is kept: it is opaque but for its alpha, and some of it scatters
// diffusely: it is neither black nor a metal all over.
bool keeps_illumination(const Material& material, TextureRanges& ranges);

// `tile`: metres; the sides of a chart are cut into equal parts of at most that. Two-sided
// materials have charts for either side. A function of the scene alone.
BakeCharts make_charts(const World& world, float tile);
// The sum of the areas of all triangles that have a chart, square metres.
double charted_area(const World& world);

}  // namespace wellspring::light
