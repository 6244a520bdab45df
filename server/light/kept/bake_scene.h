// SPDX-License-Identifier: Apache-2.0
// Describes the scene that a bake samples: a world without what moves, and its light, lamp by lamp.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct BakeScene {
  const World& world;
  Lights lights;  // lights of all lamps together
  // Tables of the light that belongs to no lamp, then of each lamp alone; one if there are no
  // lamps.
  std::vector<std::shared_ptr<const LightTables>> tables;
  std::vector<Transport> parts;
  std::vector<uint8_t> part_of;  // index in `parts` of each material's own light
  // Coarse light on which gathering walks end; null: they go on until they end by chance.
  std::shared_ptr<const IlluminationMap> known;
  int layers() const { return int(parts.size()); }
};

// Makes a scene without coarse light: no bias, more noise. `world` is borrowed, and should not have
// moving meshes: they would be baked.
BakeScene make_bake_scene_of_paths(const World& world);

// Returns whether the walk's next ray, which leaves a node, shows that it is within something
// solid.
bool is_inside(const World& world, const Walk& walk, const Hit& hit);

// Adds light straight from the sources that the walk's next ray meets, which left a node scattered
// by Lambert's law. `light` has a value for each part. The light is weighed against
// sample_direct_light() at the node (multiple importance sampling), whose part of the same light it
// completes. `inside`: the node is within something solid, and nothing is added.
void add_met_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                   bool& inside);
// Adds, likewise, light that has scattered and arrives along that ray.
void gather_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                  bool& inside);

}  // namespace wellspring::light
