// SPDX-License-Identifier: Apache-2.0
#include "light/kept/finish_bake.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/worker.h"
#include "light/kept/bake.h"
#include "light/kept/filter_nodes.h"

namespace wellspring::light {
namespace {

constexpr int seam_sweeps = 3, border_rounds = 2;
constexpr int most_places_a_seam = 64;
// Least sum of squared weights and turns at a seam: light does not reach places with less.
constexpr float least_squares = 1e-3f;

// Gives each node that is not known the mean of its known neighbours, ring by ring.
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

// Holds four nodes around a place of a chart, and how much each counts.
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

// Returns how many nodes lie along a seam in the tile at its middle.
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

// Returns how many times as much light as at the nodes falls on a mesh of that normal.
float turn_of(const IlluminationChart& chart, const NodeTaps& taps, vec3 normal,
              const NodeTurns& turns) {
  if (!chart.bent || turns.slope.empty()) return 1;
  return eval_slope(read(taps, turns.slope), read(taps, turns.normal), normal);
}

// Holds a row of nodes along a tile's border.
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
                 std::span<const IlluminationTile> tiles, std::vector<vec3>& fine,
                 const NodeTurns& coarse_turns, std::span<const vec3> fine_normals) {
  parallel_for(int(tiles.size()), [&](int t) {
    const IlluminationTile& tile = tiles[size_t(t)];
    for (uint32_t i = 0; i < tile.nodes(); i++) {
      const size_t node = tile.first + i;
      float u = float(i % (tile.columns + 1u)) / float(tile.columns),
            v = float(i / (tile.columns + 1u)) / float(tile.rows);
      const NodeTaps taps = taps_in(coarse_tiles[size_t(t)], u, v);
      float turn = 1;
      if (!coarse_turns.slope.empty())
        turn = eval_slope(read(taps, coarse_turns.slope), read(taps, coarse_turns.normal),
                          fine_normals[node]);
      fine[node] += turn * read(taps, coarse);
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
                 std::vector<vec3>& light, const NodeTurns& turns) {
  for (int sweep = 0; sweep < seam_sweeps; sweep++)
    for (const ChartSeam& seam : charts.seams) {
      const IlluminationChart &a = charts.places->charts[seam.chart[0]],
                              &b = charts.places->charts[seam.chart[1]];
      float nodes = std::max(nodes_along(a, tiles, seam), nodes_along(b, tiles, seam));
      int places = int(std::clamp(nodes, 2.0f, float(most_places_a_seam)));
      for (int i = 0; i < places; i++) {
        const float along = (float(i) + 0.5f) / float(places);
        const vec3 place = mix(seam.from, seam.to, along);
        PlaceInTile at[2] = {find_tile(a, tiles, place), find_tile(b, tiles, place)};
        if (!at[0].tile || !at[1].tile) continue;
        NodeTaps taps[2] = {taps_in(*at[0].tile, at[0].u, at[0].v),
                            taps_in(*at[1].tile, at[1].u, at[1].v)};
        const vec3 normal = normalize(mix(seam.normal[0], seam.normal[1], along));
        const float turn[2] = {turn_of(a, taps[0], normal, turns),
                               turn_of(b, taps[1], normal, turns)};
        float squares = 0;
        for (int side = 0; side < 2; side++)
          for (float w : taps[side].weight) squares += w * w * turn[side] * turn[side];
        if (!(squares > least_squares)) continue;
        const vec3 step =
            (turn[0] * read(taps[0], light) - turn[1] * read(taps[1], light)) / squares;
        for (int k = 0; k < 4; k++) {
          light[taps[0].node[k]] -= taps[0].weight[k] * turn[0] * step;
          light[taps[1].node[k]] += taps[1].weight[k] * turn[1] * step;
        }
      }
    }
}

std::vector<vec3> unpack_normals(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                                 std::span<const uint32_t> packed) {
  std::vector<vec3> normals(packed.size(), vec3(0));
  if (packed.empty()) return normals;
  std::vector<uint8_t> known(packed.size(), 0);
  for (size_t i = 0; i < packed.size(); i++)
    if (packed[i] != no_normal) normals[i] = unpack_node_normal(packed[i]), known[i] = 1;
  parallel_for(int(tiles.size()), [&](int t) {
    if (tiles[size_t(t)].nodes() > 0) fill_holes(tiles[size_t(t)], known, normals);
  });
  match_borders(charts, tiles, normals);
  return normals;
}

std::shared_ptr<const std::vector<uint32_t>> pack_normals(std::span<const vec3> normals) {
  auto packed = std::make_shared<std::vector<uint32_t>>(normals.size());
  for (size_t i = 0; i < normals.size(); i++) (*packed)[i] = pack_node_normal(normals[i]);
  return packed;
}

// Calls visit(tile) for the tiles of charts that keep slopes.
template <class Visit>
static void for_each_sloped(const Bake& bake, const Visit& visit) {
  for (size_t t = 0; t < bake.places.size(); t++)
    if (bake.charts.places->charts[bake.places[t].chart].sloped) visit(bake.direct.tiles[t]);
}

// Returns the slopes of sums for each unit of their light.
static std::vector<vec3> relative_slopes(std::span<const vec3> light, std::span<const vec3> sums) {
  std::vector<vec3> slopes(sums.size());
  for (size_t i = 0; i < sums.size(); i++) {
    const float l = luminance(light[i]);
    const vec3 slope = l > 0 ? sums[i] / l : vec3(0);
    const float longest = max_component(glm::abs(slope));
    slopes[i] = longest > most_slope ? slope * (most_slope / longest) : slope;
  }
  return slopes;
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
  // Returns the means of a layer's light, or of its slopes.
  auto means_of = [&](const BakeField& field, bool slopes, int layer) {
    const bool fine = &field == &bake.direct;
    return layer_means(field, slopes ? field.slope : field.light, layer,
                       fine ? direct_leaks : gather_leaks, if_filtered(fine ? direct : gather));
  };
  auto match = [&](std::vector<vec3>& sums, const NodeTurns& turns) {
    for (int round = 0; round < border_rounds; round++) {
      match_seams(bake.charts, map->tiles, sums, turns);
      match_borders(bake.charts, map->tiles, sums);
    }
  };
  const bool sloped = !bake.direct.slope.empty();
  const std::vector<vec3> normals = unpack_normals(bake.charts, map->tiles, bake.direct.normal),
                          coarse_normals =
                              unpack_normals(bake.charts, bake.gather.tiles, bake.gather.normal);
  parallel_each(bake.direct.layers, [&](int layer) {
    IlluminationNodes& packed = (*layers)[size_t(layer)];
    std::vector<vec3> light = means_of(bake.direct, false, layer), slope;
    const std::vector<vec3> coarse = means_of(bake.gather, false, layer);
    if (sloped) {
      slope = means_of(bake.direct, true, layer);
      const std::vector<vec3> coarse_slope = means_of(bake.gather, true, layer);
      const std::vector<vec3> turns = relative_slopes(coarse, coarse_slope);
      add_coarser(bake.gather.tiles, coarse, map->tiles, light, {turns, coarse_normals}, normals);
      add_coarser(bake.gather.tiles, coarse_slope, map->tiles, slope);
      match(slope, {});
      slope = relative_slopes(light, slope);
    } else {
      add_coarser(bake.gather.tiles, coarse, map->tiles, light);
    }
    match(light, {slope, normals});
    packed.light.resize(nodes), packed.slope.resize(slope.size(), pack_slope(vec3(0)));
    for (size_t i = 0; i < nodes; i++) packed.light[i] = pack_rgb9e5(light[i]);
    for_each_sloped(bake, [&](const IlluminationTile& tile) {
      for (size_t i = tile.first; i < size_t(tile.first) + tile.nodes(); i++)
        packed.slope[i] = pack_slope(slope[i]);
    });
  });
  if (sloped) map->normals = pack_normals(normals);
  map->layers = layers;
  map = std::make_shared<IlluminationMap>(sum_of_layers(std::move(*map), bake.colors));
  map->error = held_out_error(bake.held_out, *map);
  return map;
}

std::shared_ptr<const IlluminationMap> finish_fields(const Bake& bake, bool filtered) {
  return finish(bake, {}, {}, filtered);
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

// Share of the mean light; a bounce that adds less is the last.
static constexpr float least_bounce = 0.002f;

BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          const CoarseLightSettings& settings) {
  BakeScene scene = make_bake_scene_of_paths(world);
  BakeSettings coarse;
  coarse.gather_nodes = coarse.direct_nodes = settings.nodes;
  Bake bake = begin_bake(scene.world, places, coarse);
  if (bake.charts.tiles == 0) return scene;
  sample_fields(scene, bake, settings.direct_samples, 0);
  scene.known = finish_fields(bake, false);
  for (int bounce = 1; bounce < settings.most_bounces; bounce++) {
    check_cancelled();
    clear_samples(bake.gather);
    sample_fields(scene, bake, 0, 1);
    const float before = scene.known->mean;
    scene.known = finish_fields(bake, false);
    if (!(scene.known->mean - before > least_bounce * scene.known->mean)) break;
  }
  clear_samples(bake.gather);
  sample_fields(scene, bake, 0, settings.gather_samples);
  scene.known = finish_fields(bake, true);
  return scene;
}

}  // namespace wellspring::light
