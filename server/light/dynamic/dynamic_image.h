// SPDX-License-Identifier: Apache-2.0
// The light of lights that move or change, for one picture: computed at its resolution or half of
// it and read back per pixel, never across edges.
#pragma once
#include <span>
#include <vector>

#include "light/dynamic/direct_light.h"
#include "light/splat/splatter.h"
#include "light/transport_plan.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {

// What is scattered once: virtual lights, and what they do to a picture.
struct DynamicBounce {
  std::vector<SplatSource> sources;
  std::vector<LitProbe> probes;
  SplatLights lights;
  SplatPicture picture;
};
struct DynamicImage {
  SurfaceBuffer surfaces;  // where it was computed
  LightPlanes light;       // of each of its pixels
  DynamicBounce bounce;
};
size_t memory_bytes(const DynamicImage& image);

// As the lights that move are wanted in pictures of the show: few virtual lights, the same random
// numbers in every picture, so that light changes as smoothly as what it comes from.
SplatSettings dynamic_splat_settings();

// All cores; call after World::commit(), while nothing moves. Memory is used again.
// Sends the light of `from` into the world, for the next two, and keeps of it what may matter to
// `seen`. Same seed: the same random numbers.
void begin_bounce(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                  const SurfaceBuffer& seen, const SplatSettings& settings, SplatSeed seed,
                  DynamicBounce& bounce);
// Adds what of it falls on `surfaces` to `light`.
void add_bounce(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
                const SplatSettings& settings, SplatSeed seed, DynamicBounce& bounce,
                LightPlanes& light);
// Overwrites `light` by what falls on `surfaces`: straight from `from`, and what begin_bounce() has
// sent.
void light_surfaces(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                    const SurfaceBuffer& surfaces, const SplatSettings& settings,
                    DynamicBounce& bounce, LightPlanes& light);
// Both, for pictures of `view`.
void compute_dynamic_light(const World& world, const Lights& lights,
                           const VisibilityPass& visibility, const View& view,
                           std::span<const DynamicLight> from, const SplatSettings& settings,
                           DynamicImage& image);

// At the pixels of a run of a picture of `view`, which compute_dynamic_light() was called for.
struct RunDynamic {
  bool any = false, any_gloss = false;
  RunKnown light;  // radiance of white diffuse surfaces
  RunKnown gloss;  // radiance of highlights, where there are any
};
// `surface`: of the run, with normals.
void read_dynamic_light(const DynamicImage& image, const View& view, const VisibleRun& run,
                        const RunSurface& surface, RunDynamic& to);

// Light scattered once of those dynamic lights that stay as they are for a while, as the sun at the
// hour that was chosen: the mean of many passes of virtual lights, of other random numbers each and
// with their shadows, so that a picture at rest comes to the true light of one bounce.

struct SettledBounce {
  struct Unchanged {
    DynamicLight light;
    int pictures = 0;  // for how many it has been as it is
  };
  std::vector<Unchanged> last;  // all lights of the last picture
  DynamicLights lights;         // those of them that count as settled
  int pictures = 0;             // since they are these lights
  int passes = 0;               // in the mean
  LightPlanes mean;             // of what they scatter
};
size_t memory_bytes(const SettledBounce& settled);

// Once a picture: moves those of `from` that have settled to settled.lights, leaves the others.
void take_settled(SettledBounce& settled, DynamicLights& from);

// One of `between_passes` pictures has a pass, so that pictures keep their rate; after
// `most_passes` one of `between_late` has, for things that were moved.
inline constexpr int most_passes = 64, between_passes = 3, between_late = 32;
bool wants_pass(const SettledBounce& settled);
// Adds one to the mean. The first, by `settings`, is that of lights that have not settled, and
// counts as much as `first_weight` of the others, so that from it on the picture changes smoothly.
// Overwrites `bounce`. All cores; as light_surfaces().
inline constexpr int first_weight = 8;
void add_pass(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
              const SplatSettings& settings, SettledBounce& settled, DynamicBounce& bounce);
// Adds the mean.
void add_settled(const SettledBounce& settled, LightPlanes& light);

}  // namespace wellspring::light
