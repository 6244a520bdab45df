// SPDX-License-Identifier: Apache-2.0
// Baking: the light of illumination maps, found sample by sample for as long as there is time.
//
// Two fields of nodes. Light that has scattered before is smooth: few nodes gather it, each sample
// a ray over the cosine that ends in coarse light (light/bake/finish_bake.h), or goes on as a
// path. Light straight from its sources has shadows with edges: its nodes become finer where
// neighbours differ, which a few samples with the same random numbers at all nodes of a tile tell.
// Each of their samples is next-event estimation and a ray over the cosine, weighed against each
// other (multiple importance sampling). The parts of the light that belong to each lamp are kept
// apart.
//
// A sample is a function of its node, its number and the seed, so a bake that was interrupted goes
// on to the same bits, and shards, each with every n-th tile, add up to those of one run of as many
// passes.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "light/bake/bake_field.h"
#include "light/bake/bake_scene.h"
#include "light/bake/held_out.h"

namespace wellspring::light {

struct BakeSettings {
  size_t gather_nodes = 250000, direct_nodes = 1000000;  // at most, about
  uint64_t seed = 1;
  int shard = 0, shards = 1;
};

// Pilot samples tell the mean luminance of a tile's direct light, and the mean square of the
// differences between neighbouring nodes.
struct PilotTile {
  float light = 0, unlike = 0;
};

struct Bake {
  BakeSettings settings;
  std::string source;  // the exhibit's folder, for who merges
  BakeCharts charts;
  std::vector<TilePlace> places;  // of each tile
  BakeField direct, gather;
  std::vector<PilotTile> pilots;  // of each tile, while its nodes may become finer
  HeldOut held_out;
  std::vector<int> shards_done;  // whose tiles are here: those merged, and its own
  float tile = 0;                // as of make_charts()
  std::vector<uint8_t> direct_sight, gather_sight;  // NodeSight (light/bake/filter_nodes.h), as far
                                                    // as it was asked for; not kept on disk
  int refined = 0;                                  // rounds of finer direct nodes so far
  uint64_t passes = 0;                              // of all tiles
  uint32_t cursor = 0;                              // the next tile of the pass under way
  bool pilot() const;  // refinement goes on: it looks at all tiles, whatever the shard
};
size_t memory_bytes(const Bake& bake);

// Seconds for a large scene; may be cancelled (base/worker.h).
Bake begin_bake(const World& world, std::span<const vec3> places,
                const BakeSettings& settings = {});
// Goes on, on all cores, until `stop` says so, which is asked every few milliseconds; at least one
// step is done.
void go_on(const BakeScene& scene, Bake& bake, const std::function<bool()>& stop);

// Tiles of what eyes see by these rays (scene coordinates), each once.
std::vector<uint32_t> find_tiles(const World& world, const Bake& bake, std::span<const Ray> rays);
// Takes those of the tiles that are less than `ahead` passes ahead of the others one pass further.
// False: there are none, or the bake is not refined yet.
bool go_ahead(const BakeScene& scene, Bake& bake, std::span<const uint32_t> tiles, uint32_t ahead);

// Some more samples of each node of either field, refined or not. All cores.
void sample_fields(const BakeScene& scene, Bake& bake, int direct, int gather);

// The standard error of the light at the nodes over its mean, estimated from the samples, before
// noise is filtered (light/bake/filter_nodes.h).
float bake_error(const Bake& bake);

// Of storage at vertices of a mesh that is divided as finely: place, normal, two triangles, light.
size_t vertex_bytes(const Bake& bake);
}  // namespace wellspring::light
