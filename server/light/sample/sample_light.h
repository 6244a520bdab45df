// SPDX-License-Identifier: Apache-2.0
// Samples one light seen from one place, and finds whether anything stands between. There are two
// kinds, because only the first can also be met by a scattered ray: area light (emitting triangles,
// environment pictures) and punctual light.
#pragma once
#include <span>

#include "light/material/bsdf.h"
#include "light/sample.h"
#include "light/sample/light_tables.h"
#include "light/sample/lights.h"
#include "light/sample/transport.h"
#include "light/transport_settings.h"

namespace wellspring::light {

struct LightSample {
  vec3 direction{0};
  vec3 radiance{0};  // punctual: intensity over squared distance, as if pdf were 1
  vec3 target{0};    // end of the shadow ray, already clear of the emitter
  float distance = std::numeric_limits<float>::infinity();
  float pdf = 0;      // over solid angle; 0: nothing
  float share = 1;    // punctual: the chance with which it was drawn, of all that may matter
  int spectrum = -1;  // index into Scene::spectra of its relative power; -1: a colour is all
};

// Returns the side from which light reaches a surface of that material: its geometric normal, or 0
// for both.
vec3 lit_side(const Surface& surface, const Bsdf& bsdf);

// Picks a triangle by power and place, or a direction of the environment by brightness. `normal`:
// lit_side() of the surface.
LightSample sample_area_light(const Transport& transport, const SurfacePlace& from, vec3 normal,
                              Sampler& sampler);
inline LightSample sample_area_light(const Transport& transport, const SurfacePlace& from,
                                     Sampler& sampler) {
  return sample_area_light(transport, from, from.geometric_normal, sampler);
}
// Return the densities with which sample_area_light(from that place) would have found what a ray
// has met.
float sample_emitter_pdf(const LightTables& tables, vec3 from, vec3 normal, vec3 direction,
                         const Surface& met);
float sample_sky_pdf(const LightTables& tables, vec3 direction);

// Returns what that light alone would send there if nothing were in between (glTF
// KHR_lights_punctual: inverse square, range window, cone). `pdf` is 1, or 0 if it sends nothing;
// on the light itself it has no direction either.
LightSample eval_punctual(const PunctualLight& punctual, const SpotCone& spot,
                          const SurfacePlace& from);

// Picks one light by its unshadowed effect on a surface that scatters to its own side, or
// (`through`) to both sides; of many by power and place first. `radiance` is already divided by the
// chance of the pick. `lobe`: how the surface scatters the light, if that is known.
LightSample sample_punctual_light(const Transport& transport, const SurfacePlace& from, vec3 normal,
                                  bool through, Sampler& sampler, const LobeHint& lobe = {});

// Returns the part of the light that arrives: 0 or 1, or the tint of the thin panes in between.
vec3 eval_visibility(const Transport& transport, const SurfacePlace& from,
                     const LightSample& light);
// Returns the same along a shadow ray, whose direction may have any length.
vec3 eval_visibility(const Transport& transport, Ray ray);
// Returns the same along ray `i` of a packet, which something blocks.
vec3 eval_blocked(const Transport& transport, const RayPacket& rays, int i);

inline constexpr int most_panes = 64;  // straight through so many in a row, then the light is lost

// An event in solid glass (BsdfSample::glass) is no edge of a walk, so that a room behind ten panes
// is followed as far as one before them. Beyond `sure_glass` such events Russian roulette ends some
// of all walks, as total reflection may hold one for ever; a walk that stays for more than
// `most_glass` is lost.
inline constexpr int sure_glass = 48, most_glass = 256;
inline constexpr float glass_survival = 0.95f;

// Checks every sample before it is used.

// Makes samples fit for a Frame: light that is NaN, infinite or negative is dropped (black) and
// counted; settings.clamp is applied.
void finish_samples(const Lights& lights, const TransportSettings& settings,
                    std::span<Sample> samples);
inline Sample finish_sample(const Lights& lights, const TransportSettings& settings,
                            Sample sample) {
  finish_samples(lights, settings, std::span(&sample, 1));
  return sample;
}

}  // namespace wellspring::light
