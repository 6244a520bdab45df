// SPDX-License-Identifier: Apache-2.0
#include "light/sample/illumination_map.h"

#include <bit>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rgb9e5_simd.h"

namespace wellspring {

size_t memory_bytes(const IlluminationMap& map) {
  size_t sum = bytes_of(map.tiles) + bytes_of(map.light) + bytes_of(map.places->chart_of) +
               bytes_of(map.places->first_triangle) + bytes_of(map.places->charts);
  for (const auto& layer : *map.layers) sum += bytes_of(layer);
  return sum;
}

std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all,
                                             std::span<const LampLevel> levels) {
  auto map = std::make_shared<IlluminationMap>(all);
  const auto& layers = *all.layers;
  parallel_ranges(int(map->light.size()), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      vec3 light = unpack_rgb9e5(layers[0][i]);
      for (size_t lamp = 0; lamp + 1 < layers.size(); lamp++)
        if (levels[lamp]) light += brightness_of(levels[lamp]) * unpack_rgb9e5(layers[lamp + 1][i]);
      map->light[i] = pack_rgb9e5(light);
    }
  });
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

vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec2 at) {
  const PlaceInTile place = find_tile(chart, map.tiles, at);
  if (!place.tile) return vec3(0);
  const IlluminationTile& tile = *place.tile;
  float u = place.u * float(tile.columns), v = place.v * float(tile.rows);
  int i = std::min(int(u), tile.columns - 1), j = std::min(int(v), tile.rows - 1);
  u -= float(i), v -= float(j);
  const uint32_t* node = &map.light[tile.first + size_t(j) * (tile.columns + 1u) + size_t(i)];
  const uint32_t* above = node + tile.columns + 1;
  vec3 low = glm::mix(unpack_rgb9e5(node[0]), unpack_rgb9e5(node[1]), u);
  vec3 high = glm::mix(unpack_rgb9e5(above[0]), unpack_rgb9e5(above[1]), u);
  return glm::mix(low, high, v);
}

// Of places in one tile.
static IlluminationLanes eval_tile(const IlluminationMap& map, const IlluminationTile& tile,
                                   Lanes u, Lanes v) {
  const Lanes zero{};
  u = lanes_min(lanes_max(u, zero), all_lanes(1)) * float(tile.columns);
  v = lanes_min(lanes_max(v, zero), all_lanes(1)) * float(tile.rows);
  LaneBits i = to_whole(lanes_min(u, all_lanes(float(tile.columns - 1)))),
           j = to_whole(lanes_min(v, all_lanes(float(tile.rows - 1))));
  u -= to_float(i), v -= to_float(j);
  const uint32_t stride = tile.columns + 1u;
  const LaneBits node = tile.first + j * stride + i;
  LaneBits words[4];
  for (int k = 0; k < lane_count; k++) {
    const uint32_t* at = &map.light[node[k]];
    words[0][k] = at[0], words[1][k] = at[1];
    words[2][k] = at[stride], words[3][k] = at[stride + 1];
  }
  const Lanes weights[4] = {(1.0f - u) * (1.0f - v), u * (1.0f - v), (1.0f - u) * v, u * v};
  IlluminationLanes light{};
  for (int k = 0; k < 4; k++) {
    Lanes r, g, b;
    unpack_rgb9e5(words[k], r, g, b);
    light.red += weights[k] * r, light.green += weights[k] * g, light.blue += weights[k] * b;
  }
  return light;
}

IlluminationLanes eval_illumination(const IlluminationMap& map, const IlluminationChart& chart,
                                    Lanes u, Lanes v, LaneMask asked) {
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
    const LaneMask here = lanes_of_bits(left) & (tile == first);
    left &= ~negative_lanes(here);
    const IlluminationTile& at = map.tiles[chart.first_tile + first];
    if (at.first == no_tile) continue;
    IlluminationLanes one = eval_tile(map, at, u, v);
    light.red = here ? one.red : light.red;
    light.green = here ? one.green : light.green;
    light.blue = here ? one.blue : light.blue;
  }
  return light;
}

}  // namespace wellspring
