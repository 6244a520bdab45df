// SPDX-License-Identifier: Apache-2.0
// Light that stays: what static surfaces send back of all the light they receive, averaged over cells of
// space and direction and kept for as long as scene and lights stand still. A gathered ray that ends on
// such a surface reads it instead of walking on. World-space hashing after Binder, Fricke, Keller,
// "Massively Parallel Path Space Filtering" (2019), sections 3 and 4; frozen once made, so that a sample
// remains a function of its ray and seed.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/bsdf.h"
#include "world/surface.h"

namespace wellspring {

struct Transport;

struct RadianceGrid {
  float cell = 0.25f;          // metres
  uint32_t mask = 0;           // table size - 1; open addressing, linear probing
  std::vector<uint64_t> keys;  // 0: free
  std::vector<vec3> light;     // radiance scattered back, textures and all
  std::vector<float> count;    // samples behind it
  std::vector<uint8_t> keeps;  // of each material: opaque, dark of itself and too rough to mirror
};

struct RadianceGridSettings {
  int paths = 400000;  // random walks that fill it
  int max_depth = 9;
  int kept_depth = 5;    // surfaces met later have too little of their walk left to know their light
  uint64_t seed = 1;
  float cell = 0;      // metres; 0: a twenty-fourth of the median free view from the places
};

// Walks start at `places` (scene coordinates: where eyes are likely to be) in all directions; every
// surface they meet learns its light. All cores, a few seconds; the same grid whatever the thread count.
std::shared_ptr<const RadianceGrid> make_radiance_grid(const Transport& transport, std::span<const vec3> places,
                                                       const RadianceGridSettings& settings = {});

// Radiance a hit surface scatters back along `ray`. `footprint`: how far apart rays like this one end, its
// length over the square root of its density. False: the cell knows too little or is wider than the
// footprint allows (its edge would show), or the surface moves or does not keep its light.
bool eval_grid(const RadianceGrid& grid, const World& world, const Ray& ray, const Hit& hit, float footprint,
               vec3& radiance);

}  // namespace wellspring
