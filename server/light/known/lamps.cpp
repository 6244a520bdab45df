// SPDX-License-Identifier: Apache-2.0
#include "light/known/lamps.h"

#include <algorithm>
#include <cmath>

#include "light/random/place_key.h"
#include "light/sample/illumination_map.h"
#include "light/sample/light_tables.h"
#include "light/sample/shining.h"

namespace wellspring::light {
namespace {

constexpr float noticed = 0.1f;  // change of light, of the brighter
constexpr size_t most_cells = 1 << 20;
constexpr int never = 1 << 28;

bool differs(vec3 was, vec3 left, vec3 added) {
  float a = luminance(was), b = luminance(left + added);
  // Lights that take each other's place are another light, too.
  return luminance(was - left) + luminance(added) > noticed * std::max(a, b);
}

}  // namespace

Lights relit(const Lights& all, const World& world) {
  Lights lights = all;
  lights.tables = relit(*all.tables, world.scene(), find_emitting(world));
  auto relight = [&](const std::shared_ptr<const IlluminationMap>& map) {
    return map && map->layers->size() > 1 ? relit(*map, world.lamp_levels()) : map;
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
  for (size_t i = 0; i < exact_->cells.size(); i++) {
    const vec3 always = exact_->light[0][i];
    Known k{always, always, vec3(0), exact_->weight[i]};
    for (size_t lamp = 0; lamp < before.size(); lamp++) {
      vec3 more = exact_->light[lamp + 1][i];
      const float was = brightness_of(before[lamp]), is = brightness_of(after[lamp]);
      k.was += was * more;
      k.left += std::min(was, is) * more;
      k.added += std::max(is - was, 0.0f) * more;
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

// Coarser cells, without sides, so that few are unknown.
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
  if (!(box_.low.x <= box_.high.x)) return;  // nothing to speak of, anywhere
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

// Steps from cell to cell to the nearest of which `is_from` says so, visited nearest first:
// `visit(cell, from)`.
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

// What nothing is known of is as the nearest cell is of which something is. It changes where
// something does that is not much farther: what is asked for in vain costs less than what stays
// wrong.
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
