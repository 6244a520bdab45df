// SPDX-License-Identifier: Apache-2.0
#include "bake_particles.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "light/sample/emission.h"
#include "light/walk/light_walk.h"

namespace wellspring::test {
namespace {

constexpr int most_depth = 16;

// Calls visit(node) for the nodes that stand for a place: at a border of tiles, which all have as
// many cells in a chart, that of each.
template <class Visit>
void for_each_node_at(const Bake& bake, const BakeField& field, const Surface& surface,
                      const Visit& visit) {
  const IlluminationCharts& places = *bake.charts.places;
  uint32_t found = places.find(surface.instance, surface.triangle, surface.front);
  if (found == no_chart) return;
  const IlluminationChart& chart = places.charts[found];
  const vec2 at = place_in_chart(chart, surface.position);
  const PlaceInTile any = find_tile(chart, field.tiles, at);
  if (!any.tile) return;
  const int columns = any.tile->columns, rows = any.tile->rows;
  const int x = int(std::lround(std::clamp(at.x, 0.0f, float(chart.columns)) * float(columns))),
            y = int(std::lround(std::clamp(at.y, 0.0f, float(chart.rows)) * float(rows)));
  for (int row = std::max((y - 1) / rows, 0); row <= std::min(y / rows, chart.rows - 1); row++)
    for (int column = std::max((x - 1) / columns, 0);
         column <= std::min(x / columns, chart.columns - 1); column++)
      if (const IlluminationTile& tile =
              field.tiles[chart.first_tile + uint32_t(row * chart.columns + column)];
          tile.first != no_tile)
        visit(size_t(tile.first) + size_t(y - row * rows) * (tile.columns + 1u) +
              size_t(x - column * columns));
}

void add(float& to, float value) {
  std::atomic_ref<float>(to).fetch_add(value, std::memory_order_relaxed);
}

}  // namespace

void trace_particles(const BakeScene& scene, const Bake& bake, uint64_t first, uint64_t count,
                     BakeField& field) {
  const Transport transport{scene.world, *scene.lights.tables};
  parallel_ranges(int(count), 256, [&](int begin, int end) {
    for (int k = begin; k < end; k++) {
      Sampler sampler(mix64(first + uint64_t(k)));
      EmittedRay emitted = sample_emitted_ray(transport, sampler);
      if (!(max_component(emitted.flux) > 0)) continue;
      LightWalk walk;
      walk.ray = emitted.ray, walk.flux = emitted.flux, walk.range = emitted.range;
      Arrival arrival;
      while (walk.depth <= most_depth && arrive(transport, walk, arrival)) {
        for_each_node_at(bake, field, arrival.surface, [&](size_t node) {
          vec3* light = field.light_of(node);
          for (int c = 0; c < 3; c++) add((*light)[c], arrival.flux[c]);
          add(field.hidden[node], 1);  // how many have come
        });
        if (!arrival.lit) break;
        BsdfSample scattered = sample_bsdf(arrival.bsdf, Lobes::all, sampler);
        if (!scatter(walk, arrival, scattered, sampler)) break;
      }
    }
  });
}

void finish_particles(const World& world, const Bake& bake, uint64_t count, BakeField& field) {
  for (uint32_t t = 0; t < field.tiles.size(); t++) {
    const IlluminationTile& tile = field.tiles[t];
    const ChartSurface& surface = bake.charts.surfaces[bake.places[t].chart];
    const IlluminationChart& chart = bake.charts.places->charts[bake.places[t].chart];
    const float cell = 1 / (length(chart.along_u) * float(tile.columns) * length(chart.along_v) *
                            float(tile.rows));
    for (uint32_t node = tile.first; node < tile.first + tile.nodes(); node++) {
      float area = 0;
      for (uint32_t s = field.first_support[node]; s < field.first_support[node + 1]; s++) {
        vec3 normal = eval_face(world, surface.instance, field.supports[s].triangle);
        area += field.supports[s].area * cell / std::abs(dot(normal, surface.normal));
      }
      const float mean = area > 0 ? 1 / (area * pi * float(count)) : 0;
      const float n = std::max(field.hidden[node], 1.0f);
      vec3* light = field.light_of(node);
      *light *= mean * n;  // the mean of `count` samples is taken later
      field.count[node] = area > 0 ? n : 0;
      const float l = luminance(*light) / n;
      field.squares[node] = l * l * (2 * n - 1);  // as of a Poisson process
      field.hidden[node] = 0;
    }
  }
}

}  // namespace wellspring::test
