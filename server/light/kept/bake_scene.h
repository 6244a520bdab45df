// SPDX-License-Identifier: Apache-2.0
// Describes the scene that a bake samples: a world without what moves, and its light, lamp by lamp.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/kept/binned_light.h"
#include "light/sample/illumination_map.h"
#include "light/sample/lights.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct BakeScene {
  const World& world;
  Lights lights;  // lights of all lamps together
  // Tables of the light that belongs to no lamp, then of each lamp alone; one if there are no
  // lamps.
  std::vector<std::shared_ptr<const LightTables>> tables{};
  std::vector<Transport> parts{};
  std::vector<uint8_t> part_of{};          // index in `parts` of each material's own light
  std::shared_ptr<const WalkBins> bins{};  // null: all light is kept in colours
  // Each part's first layer of the map, and the end; and the color of its lamp if it has bins.
  std::vector<size_t> first_layer{};
  std::vector<vec3> lamp_color{};
  LayerColors colors{};  // find_layer_colors() of the scene
  // Coarse light on which gathering walks end; null: they go on until they end by chance.
  std::shared_ptr<const IlluminationMap> known{};
  size_t layers() const { return first_layer.back(); }
  const std::vector<mat3>& plain_colors() const { return colors.on(-1); }
  bool has_bins(size_t part) const { return first_layer[part + 1] - first_layer[part] > 1; }
};

// Calls visit(layer, light) for the layers of a part's light, which arrives there at once.
template <class Visit>
void for_each_layer(const BakeScene& scene, size_t part, vec3 light, const Visit& visit) {
  const size_t first = scene.first_layer[part];
  if (!scene.has_bins(part)) return visit(first, light);
  const BinnedWalk at_once(scene.bins.get());
  for (size_t l = 0; l < bin_layers; l++)
    visit(first + l, at_once.arriving(l, light / scene.lamp_color[part]));
}
// Adds the colour of light in each layer to `sum`. `colors`: LayerColors::on().
void add_color(std::span<const mat3> colors, std::span<const vec3> light, vec3& sum);

// Makes a scene without coarse light: no bias, more noise. `world` is borrowed, and should not have
// moving meshes: they would be baked.
BakeScene make_bake_scene_of_paths(const World& world);

// Returns whether the walk's next ray, which leaves a node, shows that it is within something
// solid.
bool is_inside(const World& world, const Walk& walk, const Hit& hit);

// Adds light straight from the sources that the walk's next ray meets, which left a node scattered
// by Lambert's law. `light` has a value for each layer. The light is weighed against
// sample_direct_light() at the node (multiple importance sampling), whose part of the same light it
// completes. `inside`: the node is within something solid, and nothing is added.
void add_met_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                   bool& inside);
// Adds, likewise, light that has scattered and arrives along that ray.
void gather_light(const BakeScene& scene, Walk walk, Sampler& sampler, std::span<vec3> light,
                  bool& inside);

}  // namespace wellspring::light
