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

#include "light/material/bsdf.h"
#include "light/sample/lamps_seen.h"
#include "world/surface.h"

namespace wellspring {

struct Transport;
struct LightTables;

struct RadianceGrid {
  float cell = 0.25f;          // metres
  std::vector<uint64_t> keys;  // place_key, where find_place_slot() says; 0: free
  std::vector<vec3> light;  // radiance scattered back, textures and all; of the lamps that are on
  std::vector<float> count;    // samples behind it
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

struct RadianceGridSettings {
  int paths = 400000;  // random walks that fill it
  int max_depth = 9;
  int kept_depth = 5;  // surfaces met later have too little of their walk left to know their light
  uint64_t seed = 1;
  float cell = 0;      // metres; 0: a twenty-fourth of the median free view from the places
};

// Walks start at `places` (scene coordinates: where eyes are likely to be) in all directions; every
// surface they meet learns its light. All cores, a few seconds; the same grid whatever the thread
// count. `parts`: tables of what belongs to no lamp, and of each lamp alone, while all are on:
// every walk learns the light of each of them.
std::shared_ptr<const RadianceGrid> make_radiance_grid(
    const Transport& transport, std::span<const vec3> places,
    const RadianceGridSettings& settings = {},
    std::span<const std::shared_ptr<const LightTables>> parts = {});
// Its light where lamps[i] says whether lamp i is on. Milliseconds.
std::shared_ptr<const RadianceGrid> relit(const RadianceGrid& all, std::span<const char> lamps);
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
