// SPDX-License-Identifier: Apache-2.0
#include "light/sample/illumination_map.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::light {

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

// Returns the geometric mean of some nodes, which is enough. Shadows count for a hundredth of the
// mean at least.
static float usual_light(const IlluminationMap& map) {
  constexpr size_t stride = 29;
  const std::vector<uint32_t>& light = map.nodes.light;
  double sum = 0, logs = 0, count = 0;
  auto each = [&](const auto& take) {
    for (size_t i = 0; i < light.size(); i += stride)
      take(double(luminance(unpack_rgb9e5(light[i]))));
  };
  each([&](double one) { sum += one, count++; });
  if (!(sum > 0)) return 0;
  each([&](double one) { logs += std::log(std::max(one, 0.01 * sum / count)); });
  return float(std::exp(logs / count));
}

namespace {

Lanes brightness(const Lanes3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

struct SummedLayer {
  const IlluminationNodes* nodes;
  mat3 color;
};

// Sums the layers at up to lane_count nodes from the first on.
void sum_nodes(std::span<const SummedLayer> layers, size_t first, size_t count,
               IlluminationNodes& to) {
  auto load = [&](const std::vector<uint32_t>& from) {
    if (count == size_t(lane_count)) return load_lanes<LaneBits>(&from[first]);
    uint32_t some[lane_count] = {};
    std::copy_n(&from[first], count, some);
    return load_lanes<LaneBits>(some);
  };
  const bool sloped = !to.slope.empty();
  Lanes3 sum = all_lanes(vec3(0)), slope = sum;
  for (const SummedLayer& layer : layers) {
    const LaneBits packed = load(layer.nodes->light);
    if (!any_lane(packed & all_lane_bits(0x7ffffffu))) continue;  // dark, as most of them are
    Lanes3 in_layer, turns;
    unpack_rgb9e5(packed, in_layer.x, in_layer.y, in_layer.z);
    const mat3& m = layer.color;
    const Lanes3 light =
        all_lanes(m[0]) * in_layer.x + all_lanes(m[1]) * in_layer.y + all_lanes(m[2]) * in_layer.z;
    sum = sum + light;
    if (!sloped) continue;
    unpack_slope(load(layer.nodes->slope), turns.x, turns.y, turns.z);
    slope = slope + turns * brightness(light);
  }
  const Lanes bright = brightness(sum);
  for (size_t k = 0; k < count; k++) {
    to.light[first + k] = pack_rgb9e5(sum.at(int(k)));
    if (sloped) to.slope[first + k] = pack_slope(slope.at(int(k)) / std::max(bright[k], 1e-20f));
  }
}

void sum_layers(std::span<const mat3> colors, size_t begin, size_t end, IlluminationMap& map) {
  std::vector<SummedLayer> layers;
  for (size_t l = 0; l < map.layers->size(); l++)
    if (colors[l] != mat3(0)) layers.push_back({&(*map.layers)[l], colors[l]});
  for (size_t i = begin; i < end; i += lane_count)
    sum_nodes(layers, i, std::min(end - i, size_t(lane_count)), map.nodes);
}

}  // namespace

static void sum_layers(const LayerColors& colors, IlluminationMap& map) {
  const std::vector<IlluminationNodes>& layers = *map.layers;
  map.nodes.light.resize(layers.front().light.size());
  map.nodes.slope.resize(layers.front().slope.size());
  const std::vector<mat3> same(layers.size(), mat3(1));
  parallel_ranges(int(map.nodes.light.size()), 4096, [&](int begin, int end) {
    sum_layers(colors.of.empty() ? same : colors.of[0], size_t(begin), size_t(end), map);
  });
  if (colors.of.size() > 1)
    for (const IlluminationChart& chart : map.places->charts) {
      if (chart.reflectance < 0) continue;
      for (uint32_t t = 0; t < uint32_t(chart.columns) * uint32_t(chart.rows); t++)
        if (const IlluminationTile& tile = map.tiles[chart.first_tile + t]; tile.nodes() > 0)
          sum_layers(colors.on(chart.reflectance), tile.first, size_t(tile.first) + tile.nodes(),
                     map);
    }
  map.usual = usual_light(map);
}

IlluminationMap sum_of_layers(IlluminationMap map, const LayerColors& colors) {
  sum_layers(colors, map);
  double mean = 0;
  for (uint32_t light : map.nodes.light) mean += double(luminance(unpack_rgb9e5(light)));
  const size_t nodes = map.nodes.light.size();
  map.mean = nodes > 0 ? float(mean / double(nodes)) : 0;
  return map;
}

std::shared_ptr<const IlluminationMap> relit(const IlluminationMap& all,
                                             const LayerColors& colors) {
  auto map = std::make_shared<IlluminationMap>(all);
  sum_layers(colors, *map);
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

}  // namespace wellspring::light
