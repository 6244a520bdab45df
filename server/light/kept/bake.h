// SPDX-License-Identifier: Apache-2.0
// Bakes the light of illumination maps, sample by sample for as long as there is time.
//
// There are two fields of nodes. Light that has scattered before is smooth: few nodes gather it,
// each sample a ray over the cosine that ends in coarse light (light/kept/finish_bake.h), or goes
// on as a path. Light straight from its sources has shadows with edges: its nodes become finer if
// neighbours differ, which a few samples with the same random numbers at all nodes of a tile show.
// Each sample of these nodes is next-event estimation and a ray over the cosine, weighed against
// each other (multiple importance sampling). The light of each lamp is kept apart.
//
// A sample is a function of its node, its number and the seed, so an interrupted bake continues to
// the same bits, and shards, each with every n-th tile, add up to the bits of one run of as many
// passes.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "light/kept/bake_field.h"
#include "light/kept/bake_scene.h"
#include "light/kept/held_out.h"

namespace wellspring::light {

struct BakeSettings {
  size_t gather_nodes = 250000, direct_nodes = 1000000;  // numbers of nodes at most, about
  uint64_t seed = 1;
  int shard = 0, shards = 1;
  float tile = 0;  // metres, as of make_charts(); 0: by the number of nodes
};

// Holds what a tile's pilot samples found: the mean luminance of its direct light, and the mean
// square of the differences between neighbouring nodes.
struct PilotTile {
  float light = 0, unlike = 0;
};

struct Bake {
  BakeSettings settings;
  std::string source;  // the exhibit's folder, for merging
  BakeCharts charts;
  std::vector<TilePlace> places;  // one for each tile
  BakeField direct, gather;
  LayerColors colors;             // find_layer_colors() of the scene
  std::vector<PilotTile> pilots;  // one for each tile, while nodes may become finer
  std::vector<char> sampled;      // for each tile; empty: all. Not kept on disk
  HeldOut held_out;
  std::vector<int> shards_done;  // shards whose tiles are here: its own, and merged ones
  float tile = 0;                // metres, as given to make_charts()
  std::vector<uint8_t> direct_sight, gather_sight;  // NodeSight (light/kept/filter_nodes.h), as far
                                                    // as it was asked for; not kept on disk
  int refined = 0;                                  // rounds of finer direct nodes so far
  uint64_t passes = 0;                              // complete passes over all tiles
  uint32_t cursor = 0;                              // the next tile of the pass under way
  bool pilot() const;  // whether refinement goes on; it samples all tiles, whatever the shard
};
size_t memory_bytes(const Bake& bake);

// Begins a bake; takes seconds for a large scene. May be cancelled (base/worker.h).
Bake begin_bake(const World& world, std::span<const vec3> places,
                const BakeSettings& settings = {});
// Continues a bake on all cores until `stop` returns true, which is called every few milliseconds;
// does at least one step.
void go_on(const BakeScene& scene, Bake& bake, const std::function<bool()>& stop);

// Returns the tiles that eyes see by these rays (scene coordinates), each once.
std::vector<uint32_t> find_tiles(const World& world, const Bake& bake, std::span<const Ray> rays);
// Does one more pass of each given tile that is less than `ahead` passes ahead of the bake. Returns
// false if there are none, or the bake is not refined yet.
bool go_ahead(const BakeScene& scene, Bake& bake, std::span<const uint32_t> tiles, uint32_t ahead);

// Takes more samples of each node of either field, refined or not. Uses all cores.
void sample_fields(const BakeScene& scene, Bake& bake, int direct, int gather);

// Returns the standard error of the light at the nodes over its mean, estimated from the samples,
// before noise is filtered (light/kept/filter_nodes.h).
float bake_error(const Bake& bake);

// Returns the memory that storage at the vertices of an equally fine mesh would take: place,
// normal, two triangles, light.
size_t vertex_bytes(const Bake& bake);
}  // namespace wellspring::light
