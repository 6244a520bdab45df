// SPDX-License-Identifier: Apache-2.0
#include "light/sample/illumination_map.h"

#include "base/memory.h"
#include "base/parallel.h"

namespace wellspring {

size_t memory_bytes(const IlluminationMap& map) {
  size_t sum = bytes_of(map.tiles) + bytes_of(map.light) + bytes_of(map.places->chart_of) +
               bytes_of(map.places->first_triangle) + bytes_of(map.places->charts);
  for (const auto& layer : *map.layers) sum += bytes_of(layer);
  return sum;
}

std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all,
                                             std::span<const char> lamps) {
  auto map = std::make_shared<IlluminationMap>(all);
  const auto& layers = *all.layers;
  parallel_ranges(int(map->light.size()), 4096, [&](int begin, int end) {
    for (size_t i = size_t(begin); i < size_t(end); i++) {
      vec3 light = unpack_rgb9e5(layers[0][i]);
      for (size_t lamp = 0; lamp + 1 < layers.size(); lamp++)
        if (lamps[lamp]) light += unpack_rgb9e5(layers[lamp + 1][i]);
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

vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec3 place) {
  const vec3 to = place - chart.origin;
  return eval_illumination(map, chart, vec2(dot(to, chart.along_u), dot(to, chart.along_v)));
}

vec3 eval_illumination(const IlluminationMap& map, const IlluminationChart& chart, vec2 at) {
  // A place beside the chart by rounding is taken for its edge.
  float u = glm::clamp(at.x, 0.0f, float(chart.columns)),
        v = glm::clamp(at.y, 0.0f, float(chart.rows));
  int column = std::min(int(u), chart.columns - 1), row = std::min(int(v), chart.rows - 1);
  const IlluminationTile& tile =
      map.tiles[chart.first_tile + size_t(row) * size_t(chart.columns) + size_t(column)];
  if (tile.first == no_tile) return vec3(0);
  u = (u - float(column)) * float(tile.columns), v = (v - float(row)) * float(tile.rows);
  int i = std::min(int(u), tile.columns - 1), j = std::min(int(v), tile.rows - 1);
  u -= float(i), v -= float(j);
  const uint32_t* node = &map.light[tile.first + size_t(j) * (tile.columns + 1u) + size_t(i)];
  const uint32_t* above = node + tile.columns + 1;
  vec3 low = glm::mix(unpack_rgb9e5(node[0]), unpack_rgb9e5(node[1]), u);
  vec3 high = glm::mix(unpack_rgb9e5(above[0]), unpack_rgb9e5(above[1]), u);
  return glm::mix(low, high, v);
}

}  // namespace wellspring
