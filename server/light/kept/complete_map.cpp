// SPDX-License-Identifier: Apache-2.0
#include "light/kept/complete_map.h"

#include <algorithm>

#include "light/kept/bake_field.h"
#include "light/kept/finish_bake.h"
#include "light/sample/pane_boxes.h"

namespace wellspring::light {
namespace {

uint32_t instance_of(const Bake& bake, size_t tile) {
  return bake.charts.surfaces[bake.places[tile].chart].instance;
}

bool is_there(const IlluminationTile& tile) { return tile.first != no_tile; }

// Returns the middle of a tile where its chart is projected to.
vec3 middle_of(const Bake& bake, size_t tile) {
  const TilePlace& at = bake.places[tile];
  const IlluminationChart& chart = bake.charts.places->charts[at.chart];
  const auto along = [](vec3 axis, int cell) {
    return axis * ((float(cell) + 0.5f) / dot(axis, axis));
  };
  return chart.origin + along(chart.along_u, at.column) + along(chart.along_v, at.row);
}

float distance_to(const Bounds& box, vec3 place) {
  return length(place - glm::clamp(place, box.low, box.high));
}

// Returns the boxes around things that have tiles, but no light in the map, and around lamps.
std::vector<Bounds> new_things(const World& world, const Bake& bake, const IlluminationMap& known,
                               std::span<const int> lamps) {
  std::vector<char> seen(size_t(world.instance_count()), 0), lit = seen;
  for (size_t t = 0; t < known.tiles.size(); t++) {
    const uint32_t instance = instance_of(bake, t);
    seen[instance] |= is_there(bake.gather.tiles[t]), lit[instance] |= is_there(known.tiles[t]);
  }
  std::vector<Bounds> boxes;
  for (uint32_t i = 0; i < seen.size(); i++)
    if (seen[i] && !lit[i]) boxes.push_back(bounds_of(world.placed(i)));
  const std::vector<uint8_t> parts = find_lamp_parts(world.scene());
  for (int lamp : lamps) {
    for (int light : world.scene().lamps[size_t(lamp)].lights) {
      const vec3 place = world.scene().lights[size_t(light)].position;
      boxes.push_back({place, place});
    }
    for (uint32_t i = 0; i < seen.size(); i++)
      if (parts[size_t(world.mesh_of(i).material)] == lamp + 1)
        boxes.push_back(bounds_of(world.placed(i)));
  }
  return boxes;
}

// Copies a tile's nodes to the end of `to`.
void add_nodes(const IlluminationNodes& from, const IlluminationTile& tile, bool sloped,
               IlluminationNodes& to) {
  const auto first = ptrdiff_t(tile.first), last = first + ptrdiff_t(tile.nodes());
  to.light.insert(to.light.end(), from.light.begin() + first, from.light.begin() + last);
  if (!sloped) return;
  if (from.slope.empty()) to.slope.resize(to.light.size(), pack_slope(vec3(0)));
  else to.slope.insert(to.slope.end(), from.slope.begin() + first, from.slope.begin() + last);
}

}  // namespace

std::vector<char> find_new_tiles(const World& world, const Bake& bake, const LoadedMap& loaded,
                                 float reach) {
  const IlluminationMap& known = *loaded.map;
  const std::vector<Bounds> boxes = new_things(world, bake, known, loaded.dark_lamps);
  std::vector<char> is_new(known.tiles.size(), 0);
  for (size_t t = 0; t < is_new.size(); t++) {
    if (!is_there(bake.gather.tiles[t])) continue;
    const vec3 middle = middle_of(bake, t);
    const bool near = std::ranges::any_of(
        boxes, [&](const Bounds& box) { return distance_to(box, middle) < reach; });
    is_new[t] = near || !is_there(known.tiles[t]);
  }
  return is_new;
}

std::shared_ptr<const IlluminationMap> complete_map(const World& world, const Bake& bake,
                                                    const IlluminationMap& known,
                                                    const IlluminationMap& fresh,
                                                    const std::vector<char>& is_new) {
  IlluminationMap map;
  map.places = bake.charts.places;
  map.tiles.resize(known.tiles.size());
  const bool sloped = bake.charts.sloped;
  auto layers = std::make_shared<std::vector<IlluminationNodes>>(fresh.layers->size());
  uint32_t nodes = 0;
  for (size_t t = 0; t < map.tiles.size(); t++) {
    const IlluminationMap& from = is_new[t] ? fresh : known;
    if (!is_there(from.tiles[t])) continue;
    map.tiles[t] = from.tiles[t];
    map.tiles[t].first = nodes;
    nodes += map.tiles[t].nodes();
    for (size_t layer = 0; layer < layers->size(); layer++)
      add_nodes((*from.layers)[layer], from.tiles[t], sloped, (*layers)[layer]);
  }
  map.layers = std::move(layers);
  if (sloped)
    map.normals = pack_normals(
        unpack_normals(bake.charts, map.tiles, node_normals(world, bake.charts, map.tiles, nodes)));
  map = sum_of_layers(std::move(map), bake.colors);
  map.error = known.error;
  return std::make_shared<IlluminationMap>(std::move(map));
}

}  // namespace wellspring::light
