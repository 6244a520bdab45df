// SPDX-License-Identifier: Apache-2.0
#include "light/bake/map_file.h"

#include "base/keyed_file.h"

namespace wellspring {
namespace {

constexpr uint64_t format = 0x3150414d57535701;  // changes with what is written, and with charts

void list_fields(auto& to, auto& map, auto& places, auto& layers) {
  to.value(map.error);
  to.value(map.mean);
  to.array(places.first_triangle);
  to.array(places.chart_of);
  to.array(places.charts);
  to.array(map.tiles);
  to.array(map.light);
  for (auto& layer : layers) to.array(layer);
}

// Everything that is looked up lies where it is looked for.
bool fits(const Scene& scene, const IlluminationMap& map, const IlluminationCharts& places,
          const std::vector<std::vector<uint32_t>>& layers) {
  const size_t nodes = map.light.size();
  for (const auto& layer : layers)
    if (layer.size() != nodes) return false;
  if (places.first_triangle.size() != scene.instances.size() * 2) return false;
  for (size_t i = 0; i < places.first_triangle.size(); i++) {
    const size_t triangles = scene.meshes[size_t(scene.instances[i / 2].mesh)].triangles.size();
    if (places.first_triangle[i] != no_chart &&
        places.first_triangle[i] + triangles > places.chart_of.size())
      return false;
  }
  for (uint32_t chart : places.chart_of)
    if (chart != no_chart && chart >= places.charts.size()) return false;
  for (const IlluminationChart& chart : places.charts)
    if (chart.columns < 1 || chart.rows < 1 ||
        chart.first_tile + uint64_t(chart.columns) * uint64_t(chart.rows) > map.tiles.size())
      return false;
  for (const IlluminationTile& tile : map.tiles)
    if (tile.first != no_tile &&
        (tile.columns < 1 || tile.rows < 1 || uint64_t(tile.first) + tile.nodes() > nodes))
      return false;
  return map.mean >= 0;
}

}  // namespace

bool save_map(const IlluminationMap& map, const std::string& file, uint64_t key) {
  PutBytes put;
  put.value(uint64_t(map.layers->size()));
  list_fields(put, map, *map.places, *map.layers);
  return write_keyed(file, format, key, put.bytes);
}

std::shared_ptr<const IlluminationMap> load_map(const Scene& scene, const std::string& file,
                                                uint64_t key) {
  std::string bytes;
  if (read_keyed(file, format, key, bytes) != KeyedFile::read) return nullptr;
  auto map = std::make_shared<IlluminationMap>();
  auto places = std::make_shared<IlluminationCharts>();
  TakeBytes take{bytes};
  uint64_t count = 0;
  take.value(count);
  if (count != layer_count(scene)) return nullptr;
  std::vector<std::vector<uint32_t>> layers{size_t(count)};
  list_fields(take, *map, *places, layers);
  if (!take.complete() || !fits(scene, *map, *places, layers)) return nullptr;
  map->places = places;
  map->layers = std::make_shared<const std::vector<std::vector<uint32_t>>>(std::move(layers));
  return map;
}

}  // namespace wellspring
