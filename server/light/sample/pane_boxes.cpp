// SPDX-License-Identifier: Apache-2.0
#include "light/sample/pane_boxes.h"

#include <algorithm>
#include <atomic>
#include <limits>

namespace wellspring::light {
namespace {

constexpr size_t most_boxes = 32;
constexpr float room = 1e-4f;  // relative: rays start a little off the glass

void add(Bounds& box, const Bounds& more) {
  box.low = glm::min(box.low, more.low);
  box.high = glm::max(box.high, more.high);
}

PaneBoxes in_groups(const std::vector<Bounds>& boxes) {
  PaneBoxes groups;
  groups.groups.resize((boxes.size() + lane_count - 1) / lane_count);
  for (size_t i = 0; i < groups.groups.size() * lane_count; i++) {
    const Bounds& box = boxes[std::min(i, boxes.size() - 1)];
    PaneBoxes::Group& group = groups.groups[i / lane_count];
    for (int axis = 0; axis < 3; axis++) {
      group.low[axis][i % lane_count] = box.low[axis];
      group.high[axis][i % lane_count] = box.high[axis];
    }
  }
  return groups;
}

}  // namespace

PaneBoxes make_pane_boxes(const World& world, const std::vector<MaterialTraits>& materials) {
  std::vector<Bounds> boxes;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    const PlacedMesh& placed = world.placed(i);
    if (!materials[size_t(placed.mesh->material)].maybe_pane) continue;
    Bounds box;
    if (placed.moving) {
      box.low = vec3(-std::numeric_limits<float>::infinity());
      box.high = -box.low;
      return in_groups({box});
    }
    for (const vec3& position : placed.mesh->positions) {
      vec3 p = vec3(placed.to_world * vec4(position, 1));
      if (is_finite(p)) add(box, {p, p});
    }
    if (!(box.low.x <= box.high.x)) continue;
    vec3 grow = room * (box.high - box.low + glm::max(glm::abs(box.low), glm::abs(box.high)));
    boxes.push_back({box.low - grow, box.high + grow});
  }
  // Neighbours in the file are near each other.
  size_t together = (boxes.size() + most_boxes - 1) / most_boxes;
  if (together <= 1) return in_groups(boxes);
  std::vector<Bounds> merged((boxes.size() + together - 1) / together);
  for (size_t i = 0; i < boxes.size(); i++) add(merged[i / together], boxes[i]);
  return in_groups(merged);
}

bool may_cross_pane(const PaneBoxes& boxes, const Ray& ray) {
  for (const PaneBoxes::Group& group : boxes.groups) {
    Lanes near = all_lanes(0), far = all_lanes(ray.t_max);
    for (int axis = 0; axis < 3; axis++) {
      float inverse = 1 / ray.direction[axis];
      Lanes a = (group.low[axis] - ray.origin[axis]) * inverse,
            b = (group.high[axis] - ray.origin[axis]) * inverse;
      LaneMask known = a + b == a + b;  // else within the slab, or in its plane, all along
      near = known ? lanes_max(lanes_min(a, b), near) : near;
      far = known ? lanes_min(lanes_max(a, b), far) : far;
    }
    if (negative_lanes(near <= far * 1.00001f)) return true;
  }
  return false;
}

Bounds bounds_of(const PlacedMesh& placed) {
  Bounds box;
  for (vec3 p : placed.mesh->positions) {
    if (!placed.in_place) p = vec3(placed.to_world * vec4(p, 1));
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
  }
  return box;
}

SolidBounds find_solid_bounds(const World& world, const TransportPlan& plan) {
  static std::atomic<uint64_t> keys{0};
  SolidBounds solids;
  solids.key = ++keys;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    const PlacedMesh& placed = world.placed(i);
    if (placed.moving || !plan.materials[size_t(placed.mesh->material)].solid) continue;
    Bounds box = bounds_of(placed);
    solids.each.push_back(box);
    solids.all.low = glm::min(solids.all.low, box.low);
    solids.all.high = glm::max(solids.all.high, box.high);
  }
  return solids;
}

}  // namespace wellspring::light
