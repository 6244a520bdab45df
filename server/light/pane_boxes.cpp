// SPDX-License-Identifier: Apache-2.0
#include "light/pane_boxes.h"

#include <algorithm>
#include <cmath>

namespace wellspring {
namespace {

constexpr size_t most_boxes = 32;
constexpr float room = 1e-4f;  // relative: rays start a little off the glass

void add(Bounds& box, const Bounds& more) {
  box.low = glm::min(box.low, more.low);
  box.high = glm::max(box.high, more.high);
}

}  // namespace

std::vector<Bounds> make_pane_boxes(const World& world,
                                    const std::vector<MaterialTraits>& materials) {
  std::vector<Bounds> boxes;
  for (uint32_t i = 0; i < uint32_t(world.instance_count()); i++) {
    const PlacedMesh& placed = world.placed(i);
    if (!materials[size_t(placed.mesh->material)].maybe_pane) continue;
    Bounds box;
    if (placed.moving) {
      box.low = vec3(-std::numeric_limits<float>::infinity());
      box.high = -box.low;
      return {box};
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
  if (together <= 1) return boxes;
  std::vector<Bounds> merged((boxes.size() + together - 1) / together);
  for (size_t i = 0; i < boxes.size(); i++) add(merged[i / together], boxes[i]);
  return merged;
}

bool may_cross_pane(const LightTables& tables, const Ray& ray) {
  for (const Bounds& box : tables.pane_boxes) {
    float near = 0, far = ray.t_max;
    for (int axis = 0; axis < 3; axis++) {
      float inverse = 1 / ray.direction[axis];
      float a = (box.low[axis] - ray.origin[axis]) * inverse,
            b = (box.high[axis] - ray.origin[axis]) * inverse;
      // fmin and fmax skip the NaN of a ray lying in a slab's plane.
      near = std::fmax(near, std::fmin(a, b));
      far = std::fmin(far, std::fmax(a, b));
    }
    if (near <= far * 1.00001f) return true;
  }
  return false;
}

}  // namespace wellspring
