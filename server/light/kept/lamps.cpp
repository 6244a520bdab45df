// SPDX-License-Identifier: Apache-2.0
#include "light/kept/lamps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "light/kept/binned_light.h"
#include "light/random/warp.h"
#include "light/sample/illumination_map.h"
#include "light/sample/light_tables.h"
#include "light/sample/lights.h"
#include "world/surface.h"

namespace wellspring::light {
namespace {

constexpr float wanted_cells = 4000;
constexpr float places_a_cell = 8;  // places in a cell of a flat surface

// Calls `visit(instance, triangle, front, chart, normal, area)` for all triangles that the map
// covers.
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
      // The places are a rank-1 lattice of the plastic number, folded into the triangle.
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

namespace {

constexpr float noticed = 0.1f;  // least change of light, as a share of the brighter
constexpr size_t most_cells = 1 << 20;
constexpr int never = 1 << 28;

bool differs(vec3 was, vec3 left, vec3 added) {
  float a = luminance(was), b = luminance(left + added);
  // Lights that take each other's place are a change, too.
  return luminance(was - left) + luminance(added) > noticed * std::max(a, b);
}

}  // namespace

Lights relit(const Lights& all, const World& world) {
  Lights lights = all;
  lights.tables = relit(*all.tables, world.scene(), find_emitting(world));
  const LayerColors colors = find_layer_colors(world.scene(), world.lamp_levels());
  auto relight = [&](const std::shared_ptr<const IlluminationMap>& map) {
    return map && map->layers->size() > 1 ? relit(*map, colors) : map;
  };
  lights.maps = relight(all.maps);
  lights.known = all.known == all.maps ? lights.maps : relight(all.known);
  lights.pass = nullptr;
  return lights;
}

LightChange::LightChange(const Scene& scene, const Lights& all,
                         std::shared_ptr<const LampCells> cells, std::span<const LampLevel> before,
                         std::span<const LampLevel> after) {
  if (std::equal(before.begin(), before.end(), after.begin(), after.end())) return;
  everywhere_ = !cells;
  if (everywhere_) return;
  exact_ = std::move(cells);
  const std::vector<MapLayer> layers = find_layers(scene);
  const std::vector<mat3> was_colors = find_layer_colors(scene, before).on(-1),
                          is_colors = find_layer_colors(scene, after).on(-1);
  for (size_t i = 0; i < exact_->cells.size(); i++) {
    const vec3 always = exact_->light[0][i];
    Known k{always, always, vec3(0), exact_->weight[i]};
    for (size_t l = 1; l < layers.size();) {
      vec3 was(0), is(0);
      for (const int lamp = layers[l].lamp; l < layers.size() && layers[l].lamp == lamp; l++) {
        was += was_colors[l] * exact_->light[l][i];
        is += is_colors[l] * exact_->light[l][i];
      }
      was = max(was, vec3(0)), is = max(is, vec3(0));
      k.was += was;
      k.left += min(was, is);
      k.added += max(is - was, vec3(0));
    }
    k.changes = differs(k.was, k.left, k.added);
    known_.push_back(k);
    if (!k.changes) continue;
    vec3 corner = exact_->cell * vec3(place_of_key(exact_->cells[i]));
    box_.low = glm::min(box_.low, corner);
    box_.high = glm::max(box_.high, corner + exact_->cell);
  }
  fill_cells(scene, all, before, after);
  guess_unknown();
}

// Fills coarser cells, without sides, so that few are without light.
void LightChange::fill_cells(const Scene& scene, const Lights& all,
                             std::span<const LampLevel> before, std::span<const LampLevel> after) {
  std::vector<char> switched(scene.materials.size(), 0);
  for (size_t lamp = 0; lamp < before.size(); lamp++)
    for (int material : scene.lamps[lamp].materials)
      switched[size_t(material)] = before[lamp] != after[lamp];
  std::vector<vec3> emitting;
  for (const EmitterTriangle& e : all.tables->emitters)
    if (switched[size_t(scene.meshes[size_t(scene.instances[e.instance].mesh)].material)])
      for (vec3 corner : {e.corner, e.corner + e.edge1, e.corner + e.edge2})
        if (is_finite(corner)) emitting.push_back(corner);
  for (vec3 corner : emitting) {
    box_.low = glm::min(box_.low, corner - exact_->cell);
    box_.high = glm::max(box_.high, corner + exact_->cell);
  }
  if (!(box_.low.x <= box_.high.x)) return;  // no light changes
  for (cell_ = 2 * exact_->cell;; cell_ *= 2) {
    vec3 cells = (box_.high - box_.low) / cell_ + 1.0f;
    size_ = glm::ivec3(glm::min(cells, vec3(most_cells)));
    if (double(size_.x) * size_.y * size_.z <= double(most_cells)) break;
  }
  cells_.resize(size_t(size_.x) * size_t(size_.y) * size_t(size_.z));
  for (vec3 corner : emitting) cells_[cell_at(corner)].changes = true;
  for (size_t i = 0; i < known_.size(); i++) {
    const vec3 middle = exact_->cell * (vec3(place_of_key(exact_->cells[i])) + 0.5f);
    if (!(middle == glm::clamp(middle, box_.low, box_.high))) continue;
    const Known& k = known_[i];
    Known& cell = cells_[cell_at(middle)];
    cell.was += k.weight * k.was, cell.left += k.weight * k.left, cell.added += k.weight * k.added;
    cell.weight += k.weight;
    cell.changes |= k.changes;
  }
}

// Returns the steps from each cell to the nearest one for which `is_from` is true, and calls
// `visit(cell, from)` for the others, nearest first.
template <class IsFrom, class Visit>
std::vector<int> LightChange::steps_from(const IsFrom& is_from, const Visit& visit) const {
  std::vector<int> steps(cells_.size(), never);
  std::vector<glm::ivec3> edge, next;
  for (int z = 0; z < size_.z; z++)
    for (int y = 0; y < size_.y; y++)
      for (int x = 0; x < size_.x; x++)
        if (is_from(cells_[index_of({x, y, z})]))
          edge.push_back({x, y, z}), steps[index_of({x, y, z})] = 0;
  for (int step = 1; !edge.empty(); step++) {
    for (glm::ivec3 at : edge)
      for (int axis = 0; axis < 3; axis++)
        for (int side : {-1, 1}) {
          glm::ivec3 beside = at;
          beside[axis] += side;
          if (beside[axis] < 0 || beside[axis] >= size_[axis] || steps[index_of(beside)] != never)
            continue;
          steps[index_of(beside)] = step;
          visit(index_of(beside), index_of(at));
          next.push_back(beside);
        }
    edge.swap(next);
    next.clear();
  }
  return steps;
}

// Gives each cell without light the values of the nearest cell with light. It changes if a changing
// cell is not much farther off: asking in vain costs less than light that stays wrong.
void LightChange::guess_unknown() {
  std::vector<int> to_change =
      steps_from([](const Known& k) { return k.changes; }, [](size_t, size_t) {});
  std::vector<int> to_known =
      steps_from([](const Known& k) { return k.weight > 0; },
                 [&](size_t at, size_t from) { cells_[at] = cells_[from]; });
  for (size_t i = 0; i < cells_.size(); i++)
    if (to_known[i] > 0) cells_[i].changes = to_change[i] <= 2 * to_known[i] + 1;
}

size_t LightChange::index_of(glm::ivec3 at) const {
  return (size_t(at.z) * size_t(size_.y) + size_t(at.y)) * size_t(size_.x) + size_t(at.x);
}

size_t LightChange::cell_at(vec3 place) const {
  return index_of(glm::clamp(glm::ivec3((place - box_.low) / cell_), glm::ivec3(0), size_ - 1));
}

bool LightChange::changes(vec3 place, vec3 normal, vec3& kept, vec3& added) const {
  if (everywhere_) return true;
  if (cells_.empty() || !(place == glm::clamp(place, box_.low, box_.high))) return false;
  const Known& cell = cells_[cell_at(place)];
  const uint32_t exactly = find_lamp_cell(*exact_, place, normal);
  const Known& k = exactly != no_lamp_cell ? known_[exactly] : cell;
  if (!k.changes) return false;
  const float weight = exactly != no_lamp_cell ? 1 : cell.weight;
  for (int c = 0; c < 3; c++) {
    if (k.was[c] > 0) kept[c] = std::min(k.left[c] / k.was[c], 1.0f);
    if (weight > 0) added[c] = k.added[c] / weight;
  }
  return true;
}

}  // namespace wellspring::light
