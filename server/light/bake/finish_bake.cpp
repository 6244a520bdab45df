// SPDX-License-Identifier: Apache-2.0
#include "light/bake/finish_bake.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/bake/beside.h"
#include "light/bake/unseen.h"

namespace wellspring {
namespace {

constexpr int seam_sweeps = 3, border_rounds = 2;
constexpr int most_places_a_seam = 64;

// Nodes that are not known take the mean of their known neighbours, ring by ring.
void fill_holes(const IlluminationTile& tile, std::vector<uint8_t>& known,
                std::vector<vec3>& light) {
  std::vector<std::pair<uint32_t, vec3>> found;
  for (bool more = true; more;) {
    found.clear();
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      if (known[tile.first + i]) continue;
      vec3 sum(0);
      float count = 0;
      for_each_beside(tile, i, [&](uint32_t beside) {
        if (known[tile.first + beside]) sum += light[tile.first + beside], count++;
      });
      if (count > 0) found.push_back({tile.first + i, sum / count});
    }
    for (const auto& [node, value] : found) light[node] = value, known[node] = 1;
    more = !found.empty();
  }
}

// Four nodes around a place of a chart, and how much each counts.
struct NodeTaps {
  uint32_t node[4] = {0, 0, 0, 0};
  float weight[4] = {0, 0, 0, 0};
};

NodeTaps taps_in(const IlluminationTile& tile, float u, float v) {
  u *= float(tile.columns), v *= float(tile.rows);
  int i = std::clamp(int(u), 0, tile.columns - 1), j = std::clamp(int(v), 0, tile.rows - 1);
  u = std::clamp(u - float(i), 0.0f, 1.0f), v = std::clamp(v - float(j), 0.0f, 1.0f);
  uint32_t node = tile.first + uint32_t(j) * (tile.columns + 1u) + uint32_t(i);
  return {{node, node + 1, node + tile.columns + 1u, node + tile.columns + 2u},
          {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

// How many nodes lie along a line in the tile at its middle.
float nodes_along(const IlluminationChart& chart, std::span<const IlluminationTile> tiles,
                  const ChartSeam& seam) {
  PlaceInTile at = find_tile(chart, tiles, 0.5f * (seam.from + seam.to));
  if (!at.tile) return 0;
  vec3 line = seam.to - seam.from;
  return std::max(std::abs(dot(line, chart.along_u)) * float(at.tile->columns),
                  std::abs(dot(line, chart.along_v)) * float(at.tile->rows));
}

vec3 read(const NodeTaps& taps, std::span<const vec3> light) {
  vec3 sum(0);
  for (int k = 0; k < 4; k++) sum += taps.weight[k] * light[taps.node[k]];
  return sum;
}

// Two rows of nodes that lie on one line.
struct Border {
  uint32_t first, step, cells;
  uint32_t node(uint32_t i) const { return first + i * step; }
};

void match(const Border& a, const Border& b, std::vector<vec3>& light) {
  const uint32_t coarse = std::min(a.cells, b.cells);
  for (uint32_t k = 0; k <= coarse; k++) {
    vec3 &x = light[a.node(k * (a.cells / coarse))], &y = light[b.node(k * (b.cells / coarse))];
    x = y = 0.5f * (x + y);
  }
  const Border& fine = a.cells > b.cells ? a : b;
  const uint32_t parts = fine.cells / coarse;
  for (uint32_t k = 0; k < coarse && parts > 1; k++)
    for (uint32_t i = 1; i < parts; i++)
      light[fine.node(k * parts + i)] = glm::mix(
          light[fine.node(k * parts)], light[fine.node((k + 1) * parts)], float(i) / float(parts));
}

}  // namespace

std::vector<vec3> layer_means(const BakeField& field, const std::vector<vec3>& of, int layer,
                              std::span<const uint8_t> leaks, const NodeFilter* filter) {
  std::vector<vec3> light(field.nodes(), vec3(0));
  std::vector<uint8_t> known(field.nodes(), 0);
  parallel_for(int(field.tiles.size()), [&](int t) {
    const IlluminationTile& tile = field.tiles[size_t(t)];
    for (uint32_t node = tile.first; node < tile.first + tile.nodes(); node++) {
      known[node] = field.count[node] > 0 && (leaks.empty() || !leaks[node]);
      if (known[node])
        light[node] = of[node * size_t(field.layers) + size_t(layer)] / field.count[node];
    }
  });
  if (filter) filter_nodes(field, *filter, known, light);
  parallel_for(int(field.tiles.size()), [&](int t) {
    if (field.tiles[size_t(t)].nodes() > 0) fill_holes(field.tiles[size_t(t)], known, light);
  });
  return light;
}

void add_coarser(std::span<const IlluminationTile> coarse_tiles, std::span<const vec3> coarse,
                 std::span<const IlluminationTile> tiles, std::vector<vec3>& fine) {
  parallel_for(int(tiles.size()), [&](int t) {
    const IlluminationTile& tile = tiles[size_t(t)];
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      float u = float(i % (tile.columns + 1u)) / float(tile.columns),
            v = float(i / (tile.columns + 1u)) / float(tile.rows);
      fine[tile.first + i] += read(taps_in(coarse_tiles[size_t(t)], u, v), coarse);
    }
  });
}

void match_borders(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                   std::vector<vec3>& light) {
  parallel_for(int(charts.surfaces.size()), [&](int c) {
    const IlluminationChart& chart = charts.places->charts[size_t(c)];
    // A corner that four tiles share is matched twice along each way.
    for (int round = 0; round < 2; round++)
      for (int row = 0; row < chart.rows; row++)
        for (int column = 0; column < chart.columns; column++) {
          auto at = [&](int x, int y) -> const IlluminationTile& {
            return tiles[chart.first_tile + uint32_t(y * chart.columns + x)];
          };
          const IlluminationTile& tile = at(column, row);
          if (tile.first == no_tile) continue;
          const uint32_t stride = tile.columns + 1u;
          if (column + 1 < chart.columns && at(column + 1, row).first != no_tile) {
            const IlluminationTile& right = at(column + 1, row);
            match({tile.first + tile.columns, stride, tile.rows},
                  {right.first, right.columns + 1u, right.rows}, light);
          }
          if (row + 1 < chart.rows && at(column, row + 1).first != no_tile) {
            const IlluminationTile& above = at(column, row + 1);
            match({tile.first + tile.rows * stride, 1, tile.columns},
                  {above.first, 1, above.columns}, light);
          }
        }
  });
}

void match_seams(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                 std::vector<vec3>& light) {
  for (int sweep = 0; sweep < seam_sweeps; sweep++)
    for (const ChartSeam& seam : charts.seams) {
      const IlluminationChart &a = charts.places->charts[seam.chart[0]],
                              &b = charts.places->charts[seam.chart[1]];
      float nodes = std::max(nodes_along(a, tiles, seam), nodes_along(b, tiles, seam));
      int places = int(std::clamp(nodes, 2.0f, float(most_places_a_seam)));
      for (int i = 0; i < places; i++) {
        vec3 place = mix(seam.from, seam.to, (float(i) + 0.5f) / float(places));
        PlaceInTile at[2] = {find_tile(a, tiles, place), find_tile(b, tiles, place)};
        if (!at[0].tile || !at[1].tile) continue;
        NodeTaps taps[2] = {taps_in(*at[0].tile, at[0].u, at[0].v),
                            taps_in(*at[1].tile, at[1].u, at[1].v)};
        float squares = 0;
        for (const NodeTaps& t : taps)
          for (float w : t.weight) squares += w * w;
        vec3 step = (read(taps[0], light) - read(taps[1], light)) / squares;
        for (int k = 0; k < 4; k++) {
          light[taps[0].node[k]] -= taps[0].weight[k] * step;
          light[taps[1].node[k]] += taps[1].weight[k] * step;
        }
      }
    }
}

static std::shared_ptr<const IlluminationMap> finish(const Bake& bake,
                                                     std::span<const uint8_t> direct_leaks,
                                                     std::span<const uint8_t> gather_leaks,
                                                     bool filtered) {
  auto map = std::make_shared<IlluminationMap>();
  map->places = bake.charts.places;
  map->tiles = bake.direct.tiles;
  const size_t nodes = bake.direct.nodes();
  NodeFilter direct, gather;
  if (filtered) {
    direct = make_node_filter(bake.direct, direct_leaks);
    gather = make_node_filter(bake.gather, gather_leaks);
  }
  auto if_filtered = [&](const NodeFilter& filter) { return filtered ? &filter : nullptr; };
  auto layers = std::make_shared<std::vector<IlluminationNodes>>(size_t(bake.direct.layers));
  auto finish_sums = [&](const std::vector<vec3>& fine, const std::vector<vec3>& coarse,
                         int layer) {
    std::vector<vec3> sums =
        layer_means(bake.direct, fine, layer, direct_leaks, if_filtered(direct));
    add_coarser(bake.gather.tiles,
                layer_means(bake.gather, coarse, layer, gather_leaks, if_filtered(gather)),
                map->tiles, sums);
    for (int round = 0; round < border_rounds; round++) {
      match_seams(bake.charts, map->tiles, sums);
      match_borders(bake.charts, map->tiles, sums);
    }
    return sums;
  };
  parallel_each(bake.direct.layers, [&](int layer) {
    const std::vector<vec3> light = finish_sums(bake.direct.light, bake.gather.light, layer);
    IlluminationNodes& packed = (*layers)[size_t(layer)];
    packed.light.resize(nodes);
    for (size_t i = 0; i < nodes; i++) packed.light[i] = pack_rgb9e5(light[i]);
    if (bake.direct.slope.empty()) return;
    const std::vector<vec3> slope = finish_sums(bake.direct.slope, bake.gather.slope, layer);
    packed.slope.resize(nodes);
    for (size_t i = 0; i < nodes; i++) {
      const float l = luminance(light[i]);
      packed.slope[i] = pack_slope(l > 0 ? slope[i] / l : vec3(0));
    }
  });
  map->layers = layers;
  map = std::make_shared<IlluminationMap>(sum_of_layers(std::move(*map)));
  const double light = direct.light + gather.light;
  map->error = !filtered   ? 1
               : light > 0 ? float(std::sqrt(direct.variance + direct.roughness + gather.variance +
                                             gather.roughness) /
                                   light)
                           : 0;
  return map;
}

std::shared_ptr<const IlluminationMap> finish_fields(const Bake& bake) {
  return finish(bake, {}, {}, false);
}

std::shared_ptr<const IlluminationMap> finish_map(const Bake& bake) {
  return bake.passes == 0 ? nullptr : finish(bake, {}, {}, true);
}

std::shared_ptr<const IlluminationMap> finish_map(const World& world, std::span<const vec3> eyes,
                                                  Bake& bake) {
  if (bake.passes == 0) return nullptr;
  const std::vector<uint8_t> direct = find_leaks(world, bake.charts, bake.places, eyes, bake.direct,
                                                 bake.direct_sight),
                             gather = find_leaks(world, bake.charts, bake.places, eyes, bake.gather,
                                                 bake.gather_sight);
  return finish(bake, direct, gather, true);
}

}  // namespace wellspring
