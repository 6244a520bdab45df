// SPDX-License-Identifier: Apache-2.0
#include "light/sample/illumination_map.h"

#include <bit>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rgb9e5_simd.h"

namespace wellspring {

size_t memory_bytes(const IlluminationMap& map) {
  auto bytes = [](const IlluminationNodes& nodes) {
    return bytes_of(nodes.light) + bytes_of(nodes.slope);
  };
  size_t sum = (map.normals ? bytes_of(*map.normals) : 0) + bytes_of(map.tiles) + bytes(map.nodes) +
               bytes_of(map.places->chart_of) + bytes_of(map.places->first_triangle) +
               bytes_of(map.places->charts);
  for (const IlluminationNodes& layer : *map.layers) sum += bytes(layer);
  return sum;
}

// `levels`: empty where all lamps are full.
static void sum_layers(std::span<const LampLevel> levels, IlluminationMap& map) {
  const std::vector<IlluminationNodes>& layers = *map.layers;
  const bool sloped = !layers.front().slope.empty();
  map.nodes.light.resize(layers.front().light.size());
  map.nodes.slope.resize(layers.front().slope.size());
  parallel_ranges(int(map.nodes.light.size()), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      vec3 sum(0), slope(0);
      auto add = [&](const IlluminationNodes& layer, float brightness) {
        const vec3 light = brightness * unpack_rgb9e5(layer.light[i]);
        sum += light;
        if (sloped) slope += luminance(light) * unpack_slope(layer.slope[i]);
      };
      add(layers[0], 1);
      for (size_t lamp = 0; lamp + 1 < layers.size(); lamp++)
        if (levels.empty()) add(layers[lamp + 1], 1);
        else if (levels[lamp]) add(layers[lamp + 1], brightness_of(levels[lamp]));
      map.nodes.light[i] = pack_rgb9e5(sum);
      if (sloped) map.nodes.slope[i] = pack_slope(slope / std::max(luminance(sum), 1e-20f));
    }
  });
}

IlluminationMap sum_of_layers(IlluminationMap map) {
  sum_layers({}, map);
  double mean = 0;
  for (uint32_t light : map.nodes.light) mean += double(luminance(unpack_rgb9e5(light)));
  const size_t nodes = map.nodes.light.size();
  map.mean = nodes > 0 ? float(mean / double(nodes)) : 0;
  return map;
}

std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all,
                                             std::span<const LampLevel> levels) {
  auto map = std::make_shared<IlluminationMap>(all);
  sum_layers(levels, *map);
  return map;
}

std::vector<char> mapped_objects(const Scene& scene, const IlluminationMap& map) {
  std::vector<char> mapped(scene.objects.size(), 0);
  const std::vector<uint32_t>& first = map.places->first_triangle;
  for (size_t i = 0; i < scene.instances.size() && 2 * i + 1 < first.size(); i++)
    if (first[2 * i] != no_chart && scene.instances[i].object < mapped.size())
      mapped[scene.instances[i].object] = 1;
  return mapped;
}

PlaceInTile find_tile(const IlluminationChart& chart, std::span<const IlluminationTile> tiles,
                      vec2 at) {
  float u = glm::clamp(at.x, 0.0f, float(chart.columns)),
        v = glm::clamp(at.y, 0.0f, float(chart.rows));
  int column = std::min(int(u), chart.columns - 1), row = std::min(int(v), chart.rows - 1);
  const IlluminationTile& tile =
      tiles[chart.first_tile + size_t(row) * size_t(chart.columns) + size_t(column)];
  if (tile.first == no_tile) return {};
  return {&tile, u - float(column), v - float(row)};
}

vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec3 place) {
  return eval_illumination(map, chart, place_in_chart(chart, place));
}

static IlluminationTaps taps_at(const IlluminationMap& map, const IlluminationChart& chart,
                                vec2 at) {
  const PlaceInTile place = find_tile(chart, map.tiles, at);
  if (!place.tile) return {};
  const IlluminationTile& tile = *place.tile;
  float u = place.u * float(tile.columns), v = place.v * float(tile.rows);
  const int i = std::min(int(u), tile.columns - 1), j = std::min(int(v), tile.rows - 1);
  u -= float(i), v -= float(j);
  const uint32_t stride = tile.columns + 1u, node = tile.first + uint32_t(j) * stride + uint32_t(i);
  return {{node, node + 1, node + stride, node + stride + 1},
          {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

static vec3 mix_nodes(const std::vector<uint32_t>& of, const IlluminationTaps& taps,
                      vec3 (*unpack)(uint32_t)) {
  vec3 sum(0);
  for (int k = 0; k < 4; k++)
    if (taps.weight[k] > 0) sum += taps.weight[k] * unpack(of[taps.node[k]]);
  return sum;
}

IlluminationTaps find_taps(const IlluminationMap& map, const IlluminationChart& chart, vec3 place) {
  return taps_at(map, chart, place_in_chart(chart, place));
}

vec3 eval_illumination(const IlluminationNodes& nodes, const IlluminationTaps& taps) {
  return mix_nodes(nodes.light, taps, unpack_rgb9e5);
}

vec3 eval_illumination_slope(const IlluminationNodes& nodes, const IlluminationTaps& taps) {
  return nodes.slope.empty() ? vec3(0) : mix_nodes(nodes.slope, taps, unpack_slope);
}

static bool keeps_normals(const IlluminationMap& map, const IlluminationChart& chart) {
  return chart.bent && map.normals;
}

vec3 eval_illumination_normal(const IlluminationMap& map, const IlluminationChart& chart,
                              const IlluminationTaps& taps, vec3 mesh) {
  return keeps_normals(map, chart) ? mix_nodes(*map.normals, taps, unpack_node_normal) : mesh;
}

float eval_illumination_turn(const IlluminationMap& map, const IlluminationNodes& nodes,
                             const IlluminationChart& chart, const IlluminationTaps& taps,
                             vec3 mesh, vec3 seen) {
  if (nodes.slope.empty() || !chart.sloped) return 1;
  return eval_slope(eval_illumination_slope(nodes, taps),
                    eval_illumination_normal(map, chart, taps, mesh), seen);
}

vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec2 at) {
  return eval_illumination(map.nodes, taps_at(map, chart, at));
}

// from[at[i]] in lane i.
static LaneBits gather_words(const uint32_t* from, const LaneBits& at) {
#ifdef __AVX2__
  return LaneBits(_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), __m256i(at), 4));
#else
  LaneBits words;
  for (int i = 0; i < lane_count; i++) words[i] = from[at[i]];
  return words;
#endif
}

// Of places in one tile.
static IlluminationLanes eval_tile(const IlluminationMap& map, const IlluminationTile& tile,
                                   Lanes u, Lanes v, bool sloped, bool bent) {
  const Lanes zero{};
  u = lanes_min(lanes_max(u, zero), all_lanes(1)) * float(tile.columns);
  v = lanes_min(lanes_max(v, zero), all_lanes(1)) * float(tile.rows);
  LaneBits i = to_whole(lanes_min(u, all_lanes(float(tile.columns - 1)))),
           j = to_whole(lanes_min(v, all_lanes(float(tile.rows - 1))));
  u -= to_float(i), v -= to_float(j);
  const uint32_t stride = tile.columns + 1u;
  const LaneBits node = tile.first + j * stride + i;
  const LaneBits corners[4] = {node, node + 1u, node + stride, node + stride + 1u};
  const Lanes weights[4] = {(1.0f - u) * (1.0f - v), u * (1.0f - v), (1.0f - u) * v, u * v};
  IlluminationLanes at{};
  Lanes least = all_lanes(INFINITY), most{};
  for (int k = 0; k < 4; k++) {
    Lanes r, g, b;
    unpack_rgb9e5(gather_words(map.nodes.light.data(), corners[k]), r, g, b);
    at.red += weights[k] * r, at.green += weights[k] * g, at.blue += weights[k] * b;
    least = lanes_min(least, r + g + b), most = lanes_max(most, r + g + b);
    if (!sloped) continue;
    unpack_slope(gather_words(map.nodes.slope.data(), corners[k]), r, g, b);
    at.x += weights[k] * r, at.y += weights[k] * g, at.z += weights[k] * b;
    if (!bent) continue;
    unpack_node_normal(gather_words(map.normals->data(), corners[k]), r, g, b);
    at.own_x += weights[k] * r, at.own_y += weights[k] * g, at.own_z += weights[k] * b;
  }
  at.spread = most - least;
  return at;
}

IlluminationLanes eval_illumination(const IlluminationMap& map, const IlluminationChart& chart,
                                    Lanes u, Lanes v, LaneMask asked, bool sloped) {
  sloped = sloped && !map.nodes.slope.empty();
  const bool bent = sloped && keeps_normals(map, chart);
  const Lanes zero{};
  u = lanes_min(lanes_max(u, zero), all_lanes(float(chart.columns)));
  v = lanes_min(lanes_max(v, zero), all_lanes(float(chart.rows)));
  const LaneBits column = to_whole(lanes_min(u, all_lanes(float(chart.columns - 1)))),
                 row = to_whole(lanes_min(v, all_lanes(float(chart.rows - 1)))),
                 tile = row * uint32_t(chart.columns) + column;
  u -= to_float(column), v -= to_float(row);
  IlluminationLanes light{};
  // Neighbours mostly lie in one tile, else in two.
  for (unsigned left = negative_lanes(asked); left != 0;) {
    const uint32_t first = tile[std::countr_zero(left)];
    const LaneMask same = (tile == first), here = lanes_of_bits(left) & same;
    left &= ~negative_lanes(here);
    const IlluminationTile& at = map.tiles[chart.first_tile + first];
    if (at.first == no_tile) continue;
    const IlluminationLanes one = eval_tile(map, at, u, v, sloped, bent);
    if (negative_lanes(same) == 0xff) return one;
    auto take = [&](Lanes& to, const Lanes& from) { to = here ? from : to; };
    take(light.red, one.red), take(light.green, one.green), take(light.blue, one.blue);
    take(light.spread, one.spread);
    take(light.x, one.x), take(light.y, one.y), take(light.z, one.z);
    take(light.own_x, one.own_x), take(light.own_y, one.own_y), take(light.own_z, one.own_z);
  }
  return light;
}

}  // namespace wellspring
