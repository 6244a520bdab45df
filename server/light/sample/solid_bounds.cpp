// SPDX-License-Identifier: Apache-2.0
#include "light/sample/solid_bounds.h"

#include <atomic>

namespace wellspring::light {

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
