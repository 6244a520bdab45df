// SPDX-License-Identifier: Apache-2.0
// Draws a picture by multiresolution splatting: Nichols and Wyman, "Multiresolution Splatting for
// Indirect Illumination" (2009), by rays and vector units instead of a GPU. There is one bounce:
// light goes from a source to a surface, is reflected as by Lambert, and arrives at what a pixel
// sees.
//
//   draw_virtual_lights()   once for all pictures of an instant: rays from each source
//     make_reflective_shadow_map() -> choose_virtual_lights() -> dim_hidden_lights(), if asked for
//   splat_picture()         for each picture
//     make_min_max_pyramid() -> make_subsplats() -> refine_by_visibility()
//     -> splat_shadowed_lights() or splat_lights() -> upsample()
//
// Both keep their memory: once pictures have a size and sources a number, nothing is allocated.
// It differs from the paper: rays find the maps, also of area lights and the sky; planes seen at a
// steep angle are not refined and neighbours on the two sides of an edge are never mixed
// (splat_lights.h); light near a VPL is bounded (virtual_lights.h); VPLs have shadows
// (splat_visibility.h), which the paper leaves out.
#pragma once
#include <span>
#include <vector>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/virtual/splat_lights.h"
#include "light/virtual/splat_visibility.h"

namespace wellspring::light {

// Holds what was drawn for an instant.
struct SplatLights {
  ReflectiveShadowMap map;
  VirtualLights lights;
};

// Draws the lights. `probes`: places of pictures that are wanted (find_splat_probes), for
// light_rays. The same sources, settings and seed give the same random numbers, whatever moves.
void draw_virtual_lights(const Transport& transport, std::span<const SplatSource> sources,
                         const SplatSettings& settings, SplatSeed seed,
                         std::span<const LitProbe> probes, SplatLights& drawn);

// Counts the last picture's work.
struct SplatCounters {
  static constexpr int levels = 17;
  uint64_t subsplats[levels] = {};  // one for each level: 2^level pixels a side
  uint64_t evaluations = 0;         // pairs of a VPL and a place
  uint64_t shadow_rays = 0;         // rays that light was counted by
  uint64_t probe_rays = 0;          // rays that find where visibility changes
  uint64_t all_subsplats() const {
    uint64_t sum = 0;
    for (uint64_t n : subsplats) sum += n;
    return sum;
  }
};

struct SplatPicture {
  // Indirect irradiance of each pixel, W/m^2 on its side towards the eye; 0 where nothing is lit.
  // The surface reflects albedo / pi times that.
  RawVector<vec3> irradiance;
  SplatCounters counters;
  MinMaxPyramid pyramid;
  Subsplats subsplats;
  IlluminationPyramid illumination;
  UpsampleRoom room;
  SplatShadowRoom shadows;
};
size_t memory_bytes(const SplatLights& drawn);
size_t memory_bytes(const SplatPicture& picture);

// Draws the picture on all cores. Pictures more than most_splat_side pixels wide or high remain
// dark.
void splat_picture(const Transport& transport, const SplatLights& drawn, const SplatPixels& pixels,
                   const SplatSettings& settings, SplatSeed seed, SplatPicture& picture);

// Puts about `count` lit places spread over the picture into `probes`.
void find_splat_probes(const SplatPixels& pixels, int count, std::vector<LitProbe>& probes);

// Runs technique `multires_splatting`: samples are those of `direct`; in each pass over a picture,
// the samples' places are the pixels on which VPLs of all sources are splatted, drawn
// anew for each pass. So the mean of many passes becomes direct light and one bounce.
//
// Differences from `path` with a depth of 3 remain: surfaces reflect the bounce as Lambert does on
// both ends (no highlights, no caustics; rough metal counts as matte); mirror images have no
// bounced light; subsplats blur the bounce between discontinuities, its shadows a little more; near
// VPLs it is bounded, by a radius that shrinks from pass to pass.

// Holds what one pass has drawn.
struct SplatPass {
  SplatLights drawn;
  SplatSettings settings;
  SplatSeed seed;
};

// The technique calls these between samples (light/technique/technique.h).
void begin_splat(const World& world, const TransportSettings& settings, const View& view,
                 uint64_t seed, uint32_t index, Lights& lights);
void finish_splat(const World& world, const Lights& lights, const View& view,
                  std::span<Sample> samples);

}  // namespace wellspring::light
