// SPDX-License-Identifier: Apache-2.0
// Makes a map from sums of samples: takes means, fills holes, and makes borders agree.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/kept/bake.h"
#include "light/kept/bake_scene.h"
#include "light/kept/filter_nodes.h"

namespace wellspring::light {

// Makes a map of the light found so far: holes are filled from their neighbours, and neighbouring
// tiles and charts are made to agree at their borders. Returns null before the first pass after the
// refinement is done. Takes tenths of a second. `eyes`, scene coordinates: a node that no eye can
// see does not count if it differs from a visible one.
std::shared_ptr<const IlluminationMap> finish_map(const World& world, std::span<const vec3> eyes,
                                                  Bake& bake);
// Does the same for a scene of which everything may be seen.
std::shared_ptr<const IlluminationMap> finish_map(const Bake& bake);

// Makes a map of a bake's fields as they are, refined or not. Its error is 1 (unknown) if nothing
// was held out.
std::shared_ptr<const IlluminationMap> finish_fields(const Bake& bake, bool filtered);

// The functions from here on are parts of finish_map().
// Returns the means of one layer's sums `of` the field (its light, or its slopes) at the nodes.
// Nodes without samples, and those that `leaks` names, get their neighbours' in the tile.
std::vector<vec3> layer_means(const BakeField& field, const std::vector<vec3>& of, int layer,
                              std::span<const uint8_t> leaks = {},
                              const NodeFilter* filter = nullptr);
// Holds how light at the nodes turns with the normal (light/material/light_slope.h): slopes, and
// normals of unpack_normals(). Empty: it does not turn.
struct NodeTurns {
  std::span<const vec3> slope, normal;
};
// Reads `coarse` at the nodes of finer tiles of the same charts, turns it to their normals, and
// adds it to `fine`.
void add_coarser(std::span<const IlluminationTile> coarse_tiles, std::span<const vec3> coarse,
                 std::span<const IlluminationTile> tiles, std::vector<vec3>& fine,
                 const NodeTurns& coarse_turns = {}, std::span<const vec3> fine_normals = {});
// Makes tiles of one chart agree at their common borders: the finer one follows the coarser.
void match_borders(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                   std::vector<vec3>& light);
// Makes charts agree at their seams as far as their grids allow, by Kaczmarz's iteration (least
// change of the nodes).
void match_seams(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                 std::vector<vec3>& light, const NodeTurns& turns = {});
// Returns node_normals() as maps interpolate them: holes are filled, and tiles agree at their
// borders.
std::vector<vec3> unpack_normals(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                                 std::span<const uint32_t> packed);
// Packs normals of unpack_normals() for IlluminationMap::normals.
std::shared_ptr<const std::vector<uint32_t>> pack_normals(std::span<const vec3> normals);

// Finds the light of few nodes in a second or two: a bake's gathering walks end on it, and an
// exhibit shows it as long as there is nothing better.

struct CoarseLightSettings {
  size_t nodes = 40000;  // number of nodes at most, about
  // Samples of each node; gather_samples are those of the last bounce.
  int direct_samples = 6, gather_samples = 6;
  int most_bounces = 40;
};

// Makes a scene with coarse light, null if nothing is diffuse: light straight from its sources,
// then, bounce by bounce, what surfaces send each other of the light found so far (as progressive
// radiosity: Cohen et al. 1988). Eyes are near `places` (scene coordinates). `world` is as for
// make_bake_scene_of_paths(). Uses all cores; the bits are the same whatever the number of threads.
// May be cancelled.
BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          const CoarseLightSettings& settings = {});

}  // namespace wellspring::light
