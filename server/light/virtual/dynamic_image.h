// SPDX-License-Identifier: Apache-2.0
// Computes the light of lights that move or change for one picture, at its resolution or half of
// it; it is read back per pixel, never across edges.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/transport_settings.h"
#include "light/virtual/direct_light.h"
#include "light/virtual/splatter.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {

// Holds light that is scattered once: VPLs, and the light they send to a picture.
struct DynamicBounce {
  std::vector<SplatSource> sources;
  std::vector<LitProbe> probes;
  SplatLights lights;
  SplatPicture picture;
};
struct DynamicImage {
  SurfaceBuffer surfaces;  // surfaces for which it was computed
  LightPlanes light;       // light of each of their pixels
  DynamicBounce bounce;
  DynamicLights from;  // the lights, as they were sent into the world, and how
  SplatSettings settings;
};
size_t memory_bytes(const DynamicImage& image);

// Returns the settings for pictures of the show: few VPLs, the same random numbers in
// every picture, so that light changes as smoothly as its source.
SplatSettings dynamic_splat_settings();

// Sends the light of `from` into the world, for the next two functions, and keeps what may matter
// to `seen`. The same seed gives the same random numbers. Runs on all cores and uses memory again;
// call it after World::commit(), while nothing moves.
void begin_bounce(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                  const SurfaceBuffer& seen, const SplatSettings& settings, SplatSeed seed,
                  DynamicBounce& bounce);
// Adds the bounced light that falls on `surfaces` to `light`.
void add_bounce(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
                const SplatSettings& settings, SplatSeed seed, DynamicBounce& bounce,
                LightPlanes& light);
// Overwrites `light` by the light that falls on `surfaces`: straight from `from`, and what
// begin_bounce() has sent.
void light_surfaces(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                    const SurfaceBuffer& surfaces, const SplatSettings& settings,
                    DynamicBounce& bounce, LightPlanes& light);
// Does both, for pictures of `view`.
void compute_dynamic_light(const World& world, const Lights& lights,
                           const VisibilityPass& visibility, const View& view,
                           std::span<const DynamicLight> from, const SplatSettings& settings,
                           DynamicImage& image);

// Overwrites `light` by the same light on other surfaces, which lie in that view; straight from
// `from`, some of the image's lights or all of them.
void light_others(const World& world, const Lights& lights, const DynamicImage& image,
                  std::span<const DynamicLight> from, const SurfaceBuffer& surfaces,
                  SplatPicture& bounce, LightPlanes& light);

// Holds light at the pixels of a run of a picture of `view`, which compute_dynamic_light() was
// called for.
struct RunDynamic {
  bool any = false, any_gloss = false;
  RunKnown light;  // radiance of white diffuse surfaces
  RunKnown gloss;  // radiance of highlights, if there are any
};
// Reads it. `surface`: the run's, with normals.
void read_dynamic_light(const DynamicImage& image, const View& view, const VisibleRun& run,
                        const RunSurface& surface, RunDynamic& to);

// Keeps light scattered once by dynamic lights that stay as they are for a while, as the sun at the
// hour that was chosen: the mean of many passes of VPLs, each with other random numbers
// and with shadows, so that a picture at rest comes to the true light of one bounce.

struct SettledBounce {
  struct Unchanged {
    DynamicLight light;
    int pictures = 0;  // number of pictures in which it has not changed
  };
  std::vector<Unchanged> last;  // all lights of the last picture
  DynamicLights lights;         // the settled ones among them
  int pictures = 0;             // pictures since the settled lights last changed
  int passes = 0;               // passes in the mean
  LightPlanes mean;             // mean of their scattered light
};
size_t memory_bytes(const SettledBounce& settled);

// Moves those of `from` that have settled to settled.lights, once a picture; leaves the others.
void take_settled(SettledBounce& settled, DynamicLights& from);

// One in `between_passes` pictures has a pass, so that pictures keep their rate; after
// `most_passes` passes one in `between_late` has, for things that were moved.
inline constexpr int most_passes = 64, between_passes = 3, between_late = 32;
bool wants_pass(const SettledBounce& settled);
// Adds a pass to the mean. The first, by `settings`, is the same as for lights that have not
// settled, and counts as much as `first_weight` of the others, so that the picture changes smoothly
// from it on. Overwrites `bounce`. Runs on all cores, as light_surfaces() does.
inline constexpr int first_weight = 8;
void add_pass(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
              const SplatSettings& settings, SettledBounce& settled, DynamicBounce& bounce);
// Adds the mean to `light`.
void add_settled(const SettledBounce& settled, LightPlanes& light);

// Keeps the still surfaces of a picture at rest, as the light of lights that move needs them: found
// once while the view stays, so that only the light is new in each picture.

struct BackdropSurfaces {
  View view;               // view of the picture
  SurfaceBuffer surfaces;  // in its dynamic_light_view(), without what moves
  // Three for each pixel: 255 times its root; 0 if the pixel only emits
  std::vector<uint8_t> reflectance;
  // For each pixel the weights, in 255ths, of the four pixels of light around it, by light_taps(),
  // the first in the lowest byte. Empty: light has the picture's resolution.
  RawVector<uint32_t> shares;
};
size_t memory_bytes(const BackdropSurfaces& backdrop);

// Fills `backdrop`. The view must be one that visibility.rasterises().
void find_backdrop_surfaces(const VisibilityPass& visibility, const View& view,
                            BackdropSurfaces& backdrop);

// Replaces what a pixel of its view shows, once its surfaces are what light falls on. `grid`: of
// their view.
void show_pixel(BackdropSurfaces& backdrop, const PixelGrid& grid, int x, int y,
                const SeenPoint& seen, vec3 reflectance);

// Computes the radiance that the pixels [x, x + count) of row y reflect of that light.
void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to);

}  // namespace wellspring::light
