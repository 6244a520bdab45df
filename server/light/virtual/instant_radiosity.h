// SPDX-License-Identifier: Apache-2.0
// Implements the technique `instant_radiosity`: Wald, Kollig, Benthin, Keller, Slusallek,
// "Interactive Global Illumination using Fast Ray Tracing" (2002), section 4, after Keller,
// "Instant Radiosity" (1997).
//
// Quasi-random walks make light into virtual point lights (VPLs); a pixel asks those of its set,
// one of columns x rows (section 4.2), and finish_pass averages neighbours of all sets
// (section 4.3). Every path of light is found in one way, which depends on its scatterings counted
// from the eye, sharp or rough (light_walk.h):
//   eye, sharp ...                  followed by rays
//   rough, then a light or rough    point lights, clipped if they are nearer than `clip`; a ray
//                                   gathers what clipping took, or it is missing
//   rough, then sharp ..., a light  caustic photons (section 4.1; caustic_photons.h)
//   rough, then sharp ..., rough    gathered by a ray
// The technique differs from the paper: lights are chosen by their effect on the view
// (region_lights.h) and a few of those for each region of the picture (region_lights.h), so that
// there are many more lights than shadow rays of a pixel, in lists that interleave in a pattern of
// their own, twice as wide as that of sets; the first passes' irradiance is averaged over that
// pattern, too, which later passes make good; edges get more rays from the eye
// (discontinuity_buffer.h); Owen scrambling, which adds to the paper's XOR by a random bit vector
// only that the vector depends on the bits before, and decorrelates the dimensions of the shared
// Sampler better; rays instead of nothing for the last line; sets complement each other over passes
// as well. Walks of light and of the eye that meet dispersive glass carry wavelengths from there
// (dispersion.h). If both do, they are joined if their hues are near each other (meet_hues): a blur
// along the spectrum, as that of photons is one along the surface. Light of moving emitters is not
// claimed.
#pragma once
#include <span>

#include "light/virtual/instant_pass.h"
#include "light/sample.h"
#include "light/sample/lights.h"
#include "world/view.h"

namespace wellspring::light {

// Draws a pass for any view: every walk's lights are kept.
InstantPass draw_instant_pass(const Transport& transport, const TransportSettings& settings,
                              int picture_width, uint64_t seed, uint32_t index);
// Draws a pass for this view: more walks are drawn, and the lights that do something to it are kept
// (region_lights.h).
InstantPass draw_instant_pass(const Transport& transport, const TransportSettings& settings,
                              const View& view, uint64_t seed, uint32_t index);

// The technique's functions between samples (light/technique/technique.h).
void begin_instant(const World& world, const TransportSettings& settings, const View& view,
                   uint64_t seed, uint32_t index, Lights& lights);
void finish_instant(const World& world, const Lights& lights, const View& view,
                    std::span<Sample> samples);

}  // namespace wellspring::light
