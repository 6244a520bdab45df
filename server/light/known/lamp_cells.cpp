// SPDX-License-Identifier: Apache-2.0
#include "light/known/lamp_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/random/place_key.h"
#include "light/random/warp.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float wanted_cells = 4000;
constexpr float places_a_cell = 8;  // of a flat surface

// Calls `visit(instance, triangle, front, chart, normal, area)` for all that the map knows.
template <class Visit>
void for_each_known(const World& world, const IlluminationMap& map, const Visit& visit) {
  const uint32_t count = uint32_t(world.scene().instances.size());
  for (uint32_t instance = 0; instance < count; instance++)
    for (uint32_t t = 0; t < world.mesh_of(instance).triangles.size(); t++)
      for (bool front : {true, false}) {
        const uint32_t chart = map.places->find(instance, t, front);
        if (chart == no_chart) continue;
        float area = 0;
        const vec3 normal = eval_face(world, instance, t, &area) * (front ? 1.0f : -1.0f);
        if (area > 0 && std::isfinite(area)) visit(instance, t, chart, normal, area);
      }
}

// Adds a surface's light to the cell of that key.
void add_light(uint64_t key, const IlluminationMap& map, const IlluminationTaps& taps, float weight,
               LampCells& to) {
  const uint32_t slot = find_place_slot(to.keys, key);
  if (to.keys[slot] == 0) {
    to.keys[slot] = key;
    to.number_of[slot] = uint32_t(to.cells.size());
    to.cells.push_back(key);
    to.weight.push_back(0);
    for (std::vector<vec3>& light : to.light) light.push_back(vec3(0));
  }
  const uint32_t number = to.number_of[slot];
  to.weight[number] += weight;
  for (size_t layer = 0; layer < to.light.size(); layer++) {
    vec3& mean = to.light[layer][number];
    mean += (eval_illumination((*map.layers)[layer], taps) - mean) * (weight / to.weight[number]);
  }
}

}  // namespace

LampCells make_lamp_cells(const World& world, const IlluminationMap& map) {
  LampCells cells;
  double whole = 0;
  size_t places = 0;
  for_each_known(world, map,
                 [&](uint32_t, uint32_t, uint32_t, vec3, float area) { whole += double(area); });
  cells.cell = std::max(float(std::sqrt(whole / wanted_cells)), 1e-6f);
  auto places_on = [&](float area) {
    const float wanted = places_a_cell * area / (cells.cell * cells.cell);
    return uint32_t(glm::clamp(std::ceil(wanted), 1.0f, places_a_cell * wanted_cells));
  };
  for_each_known(world, map, [&](uint32_t, uint32_t, uint32_t, vec3, float area) {
    places += places_on(area);
  });
  cells.keys.assign(std::bit_ceil(2 * places + 2), 0);
  cells.number_of.assign(cells.keys.size(), 0);
  cells.light.resize(map.layers->size());
  for_each_known(world, map, [&](uint32_t instance, uint32_t t, uint32_t chart, vec3 n, float a) {
    const uint32_t count = places_on(a);
    for (uint32_t i = 0; i < count; i++) {
      // Rank-1 lattice of the plastic number, folded into the triangle.
      vec2 u = glm::fract(vec2(0.7548776662f, 0.5698402910f) * (float(i) + 0.5f));
      if (u.x + u.y > 1) u = 1.0f - u;
      const vec3 place = eval_position(world, instance, t, u);
      if (!is_finite(place)) continue;
      const IlluminationTaps taps = find_taps(map, map.places->charts[chart], place);
      if (taps.weight[0] + taps.weight[1] + taps.weight[2] + taps.weight[3] > 0)
        add_light(place_key(place, n, cells.cell), map, taps, a / float(count), cells);
    }
  });
  return cells;
}

uint32_t find_lamp_cell(const LampCells& cells, vec3 place, vec3 normal) {
  const uint32_t slot = find_place_slot(cells.keys, place_key(place, normal, cells.cell));
  return cells.keys[slot] != 0 ? cells.number_of[slot] : no_lamp_cell;
}

}  // namespace wellspring::light
