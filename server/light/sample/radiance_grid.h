// SPDX-License-Identifier: Apache-2.0
// Light that stays: what static surfaces send back of all the light they receive, averaged over
// cells of space and direction and kept for as long as scene and lights stand still. A gathered ray
// that ends on such a surface reads it instead of walking on. World-space hashing after Binder,
// Fricke, Keller, "Massively Parallel Path Space Filtering" (2019), sections 3 and 4; frozen once
// made, so that a sample remains a function of its ray and seed.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/sample/lamps_seen.h"
#include "world/surface.h"

namespace wellspring {

struct RadianceGrid {
  float cell = 0.25f;          // metres
  std::vector<uint64_t> keys;  // place_key, where find_place_slot() says; 0: free
  std::vector<vec3> light;   // radiance scattered back, textures and all; of the lamps as they are
  std::vector<float> count;  // samples behind it
  std::shared_ptr<const LampsSeen> lamps;  // may be null
  std::vector<uint8_t> keeps;  // of each material: opaque, dark of itself and too rough to mirror
  // Where lamps can be switched: the slots in use, the mean reflectance there, and the light of
  // each by what belongs to no lamp and by each lamp alone. Copies share them.
  struct Parts {
    std::vector<uint32_t> slots;
    std::vector<vec3> albedo;
    std::vector<std::vector<vec3>> light;
  };
  std::shared_ptr<const Parts> parts = nullptr;
};
inline constexpr float enough_grid_samples = 12;  // a cell with fewer is not asked

// Its light where lamp i is as bright as levels[i]. Milliseconds.
std::shared_ptr<const RadianceGrid> relit(const RadianceGrid& all,
                                          std::span<const LampLevel> levels);
// The slot of a surface there: of light that was met, or a free one.
uint32_t find_grid_slot(const RadianceGrid& grid, vec3 place, vec3 normal);
// Where a slot's light was met: the cell's corners are `cell` times this and one more.
glm::ivec3 grid_place(const RadianceGrid& grid, uint32_t slot);

// Radiance a hit surface scatters back along `ray`. `footprint`: how far apart rays like this one
// end, its length over the square root of its density. False: the cell knows too little or is wider
// than the footprint allows (its edge would show), or the surface moves or does not keep its light.
bool eval_grid(const RadianceGrid& grid, const World& world, const Ray& ray, const Hit& hit,
               float footprint, vec3& radiance);

}  // namespace wellspring
