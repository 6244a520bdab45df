// SPDX-License-Identifier: Apache-2.0
// The light of lights that move or change, for one picture: computed at its resolution or half of
// it and read back per pixel, never across edges.
#pragma once
#include <span>

#include "light/dynamic/direct_light.h"
#include "light/dynamic/dynamic_light.h"
#include "light/dynamic/light_taps.h"
#include "light/splat/splatter.h"
#include "light/transport_settings.h"
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

}  // namespace wellspring::light
