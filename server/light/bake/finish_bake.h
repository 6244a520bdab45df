// SPDX-License-Identifier: Apache-2.0
// From sums of samples to a map: means, holes filled, borders that agree.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "light/bake/bake.h"
#include "light/bake/bake_scene.h"
#include "light/bake/filter_nodes.h"

namespace wellspring::light {

// What is known so far: holes are filled from their neighbours, and neighbouring tiles and charts
// made to agree where they meet. Null before the first pass after the refinement is done. Tenths of
// a second.
// `eyes`, scene coordinates: what no eye can see does not count where it is unlike what one sees.
std::shared_ptr<const IlluminationMap> finish_map(const World& world, std::span<const vec3> eyes,
                                                  Bake& bake);
// The same where everything may be seen.
std::shared_ptr<const IlluminationMap> finish_map(const Bake& bake);

// Makes a map of a bake's fields as they are, refined or not. Nobody knows its error (1) where
// nothing was held out.
std::shared_ptr<const IlluminationMap> finish_fields(const Bake& bake, bool filtered);

// Its parts.
// Means of one layer's sums `of` the field (its light, or its slopes) at the nodes. Nodes without
// samples, and those that `leaks` names, get their neighbours' in the tile.
std::vector<vec3> layer_means(const BakeField& field, const std::vector<vec3>& of, int layer,
                              std::span<const uint8_t> leaks = {},
                              const NodeFilter* filter = nullptr);
// How light at the nodes turns with the normal (light/material/light_slope.h): slopes, and normals
// of unpack_normals(). Empty: it does not.
struct NodeTurns {
  std::span<const vec3> slope, normal;
};
// `coarse` read at the nodes of finer tiles of the same charts, turned to their normals, and added
// to `fine`.
void add_coarser(std::span<const IlluminationTile> coarse_tiles, std::span<const vec3> coarse,
                 std::span<const IlluminationTile> tiles, std::vector<vec3>& fine,
                 const NodeTurns& coarse_turns = {}, std::span<const vec3> fine_normals = {});
// Tiles of one chart are made to agree at their common borders: the finer one follows the coarser.
void match_borders(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                   std::vector<vec3>& light);
// Charts are made to agree at their seams as far as their grids allow, by Kaczmarz's iteration
// (least change of the nodes).
void match_seams(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                 std::vector<vec3>& light, const NodeTurns& turns = {});
// node_normals() as maps interpolate them: holes are filled, and tiles agree at their borders.
std::vector<vec3> unpack_normals(const BakeCharts& charts, std::span<const IlluminationTile> tiles,
                                 std::span<const uint32_t> packed);
// IlluminationMap::normals of those.
std::shared_ptr<const std::vector<uint32_t>> pack_normals(std::span<const vec3> normals);

// Light of few nodes, found in a second or two: on it gathering walks of a bake end, and it is what
// an exhibit shows that has nothing better yet.

struct CoarseLightSettings {
  size_t nodes = 40000;                        // at most, about
  int direct_samples = 6, gather_samples = 6;  // of each node; those of the last bounce
  int most_bounces = 40;
};

// A scene of which coarse light is known, null where nothing is diffuse: light straight from its
// sources, then bounce by bounce what surfaces send each other of what is known so far (as
// progressive radiosity: Cohen et al. 1988). Eyes are near `places` (scene coordinates). `world` as
// for make_bake_scene_of_paths(). All cores; the same bits whatever the number of threads. May be
// cancelled.
BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          const CoarseLightSettings& settings = {});

}  // namespace wellspring::light
