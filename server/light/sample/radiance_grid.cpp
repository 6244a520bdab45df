// SPDX-License-Identifier: Apache-2.0
#include "light/sample/radiance_grid.h"

#include "light/random/place_key.h"

namespace wellspring {

std::shared_ptr<const RadianceGrid> relit(const RadianceGrid& all,
                                          std::span<const LampLevel> levels) {
  auto grid = std::make_shared<RadianceGrid>(all);
  const RadianceGrid::Parts& parts = *all.parts;
  for (size_t i = 0; i < parts.slots.size(); i++) {
    vec3 light = parts.light[0][i];
    for (size_t lamp = 0; lamp + 1 < parts.light.size(); lamp++)
      if (levels[lamp]) light += brightness_of(levels[lamp]) * parts.light[lamp + 1][i];
    grid->light[parts.slots[i]] = light;
  }
  return grid;
}

uint32_t find_grid_slot(const RadianceGrid& grid, vec3 place, vec3 normal) {
  return find_place_slot(grid.keys, place_key(place, normal, grid.cell));
}

glm::ivec3 grid_place(const RadianceGrid& grid, uint32_t slot) {
  uint64_t key = grid.keys[slot] >> 1;
  auto part = [&](int shift) { return int(key >> shift & 0xfffff) - (1 << 19); };
  return {part(40), part(20), part(0)};
}

bool eval_grid(const RadianceGrid& grid, const World& world, const Ray& ray, const Hit& hit,
               float footprint, vec3& radiance) {
  const PlacedMesh& placed = world.placed(hit.instance);
  if (footprint < 2 * grid.cell || placed.moving || !grid.keeps[size_t(placed.mesh->material)])
    return false;
  vec3 normal = eval_face(world, hit.instance, hit.triangle);
  if (dot(normal, ray.direction) > 0) normal = -normal;
  uint32_t slot = find_grid_slot(grid, ray.origin + hit.t * ray.direction, normal);
  if (grid.count[slot] < enough_grid_samples) return false;
  radiance = grid.light[slot];
  return true;
}

}  // namespace wellspring
