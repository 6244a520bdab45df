// SPDX-License-Identifier: Apache-2.0
// Follows the random walk that `path` and `direct` share: next-event estimation and scattering
// combined by multiple importance sampling (Veach 1997, chapter 9), with thin smooth panes passed
// straight by light and eye alike. The first surface is treated with more care, because its parts
// are kept apart in the Sample.
#pragma once
#include <optional>

#include "light/material/dispersion.h"
#include "light/material/lambert.h"
#include "light/sample.h"
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {

// Parts the colours of walks at dispersive surfaces (dispersion.h): at a solid's own boundary,
// between the indices on both its sides. Walks of the eye and of light call the same functions.

// Returns whether a surface parts colours; never true if the plan has no dispersion.
bool parts_colors(const Transport& transport, const Media& media, const Surface& surface);

// Parts the colours of a ray of that direction, if parts_colors(): calls spread_wavelengths with
// the media on both sides. Draws the hero if the walk has all wavelengths.
void part_colors(const Transport& transport, const Media& media, vec3 direction,
                 const Surface& surface, const Wavelengths& carried, Sampler& sampler, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread);

struct WalkRules {
  int max_depth = 8;          // edges, without panes passed straight and what glass does
  int scatterings = 1 << 30;  // surfaces that may scatter other than perfectly; then one edge more
  // >0: a surface that a ray met by chance reflects no sharper than the ray is wide: its alpha is
  // at least `blunt` over the root of the ray's density. A small lamp's highlight that a wide ray
  // comes upon is a spark (Kaplanyan and Dachsbacher 2013, "Path Space Regularization"). Biased.
  float blunt = 0;
  // The first surface's diffuse light is read from Transport::maps, if nothing that moves is likely
  // to change it; else it is sampled, and counted in multiples of the map's.
  bool reads_maps = false;
};

// Holds one walk in flight: the ray that comes next, and the place that it left.
struct Walk {
  Ray ray;
  vec3 throughput{1};
  int depth = 1;  // this ray's number, counted from the eye, without what solid glass did
  int glass = 0;  // edges that solid glass did (sample_light.h)
  float pdf = 0;  // density of its direction where it last scattered; 0: perfect, or the eye
  vec3 from_normal{0, 1, 0};  // side from which light was sampled at `from`
  vec3 from{0};               // place that the ray left
  float area_share = 0;       // chance that area light was sampled at `from`; 0: it was not
  Media media;                // media that the ray runs in, and beyond the surface it met last
  // Factor by which radiance is denser in `media` (squared index), for the roulette.
  float density = 1;
  int scattered = 0;
  int panes = 0;            // panes passed in a row
  Wavelengths wavelengths;  // `throughput` is without their tint
  int edges() const { return depth + glass; }
};

inline constexpr int roulette_depth = 2;  // edges that Russian roulette never cuts short

// Returns the radiance that comes back along the walk, times its throughput.
vec3 follow(const Transport& transport, const WalkRules& rules, Walk walk, Sampler& sampler);
// Does the same if the first hit of the walk's ray is known.
vec3 follow(const Transport& transport, const WalkRules& rules, Walk walk, Hit hit,
            Sampler& sampler);

// Returns whether a volume stops the walk's ray before t_end; if so, adds the light that its matter
// sends back. Matter in a volume scatters nothing on: the walk ends. Light that is spread wide
// meets no volume that shows the largest value along a ray, as it casts no shadow either.
bool ends_in_volume(const Transport& transport, const Walk& walk, float t_end, vec3& radiance);

// Returns emission met by the walk's ray, with the walk's tint, weighted against the chance that
// light sampling had found it from the place that the ray left.
vec3 walk_met_emission(const Transport& transport, const Walk& walk, const Surface& surface,
                       const Material& material);
vec3 walk_met_sky(const Transport& transport, const Walk& walk);

// Numbers a sample's dimensions: the eye's way to the first surface comes first, then each walk has
// a block of its own, and each of its surfaces a place in it, so that a number means the same in
// all samples of a pixel.
struct Dimensions {
  static constexpr uint32_t first_surface = 96;  // panes come before
  static constexpr uint32_t walk = 1u << 16;     // the k-th walk begins at k times this
  static constexpr uint32_t surface = 32;        // from one surface of a walk to the next
  // Offsets within a surface's dimensions.
  static constexpr uint32_t punctual = 4, scatter = 8, specular = 16, survival = 24,
                            wavelength = 28, absorbed = 29, lobe = 30;
};

// Parts the colours if `surface` does so: `bsdf` becomes the hero wavelength's. After sampling,
// `spread`, if set, goes to carry_wavelengths.
void part_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                 uint32_t dimensions, Sampler& sampler, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread);

// Returns tint_of() the walk's wavelengths.
inline vec3 walk_tint(const Transport& transport, const Walk& walk, int lamp = -1) {
  if (walk.wavelengths.in_color()) return vec3(1);
  return tint_of(*transport.tables.spectral, walk.wavelengths, lamp);
}
// Lets the solid that the walk runs in absorb light over a length.
void absorb(const Transport& transport, Walk& walk, float length, uint32_t dimensions,
            Sampler& sampler);
// Tells wavelengths that the Lambertian surface at a hit scattered them, likewise.
void reflect(const Transport& transport, const Hit& hit, uint32_t dimensions, Sampler& sampler,
             Wavelengths& carried);
// Returns whether a material's specular lobes have its base colour as its diffuse one has.
inline bool tints_gloss(const Material& material) { return material.metallic >= 0.5f; }
// Tells wavelengths that a surface of that material scattered them by `lobes`, if its reflectance
// is known by wavelength. One of all lobes together is chosen, and the sample's weight becomes that
// lobe's over its chance: so a walk that has all wavelengths keeps them.
void reflect(const Transport& transport, const Material& material, const Bsdf& bsdf, Lobes lobes,
             uint32_t dimensions, Sampler& sampler, BsdfSample& scattered, Wavelengths& carried);

// Makes the walk's next ray after `place` scattered it; returns false if the walk ends here.
bool advance(Walk& walk, const SurfacePlace& place, const BsdfSample& scattered);

// Holds light that arrives at a surface from one area light and one punctual light, scattered
// towards the viewer.
struct DirectLight {
  vec3 area_diffuse{0}, punctual_diffuse{0}, specular{0};
  vec3 area_direction{0}, punctual_direction{0};  // directions to these lights; 0: there is none
  // Light from there before the surface scatters it, for lobes that are sampled as a mixture.
  vec3 area_arrives{0}, punctual_arrives{0};
  float punctual_share = 1;  // LightSample::share
  bool sure_of_punctual() const { return punctual_share > 0.99f; }
  vec3 sum() const { return area_diffuse + punctual_diffuse + specular; }
};
// Samples the light that arrives at a surface; it has the tint of the walk and of the surface.
// `apart`: the caller samples the diffuse and specular lobes one by one (else as a mixture), and
// both kinds of light are sampled (else one of them, by area_share).
DirectLight sample_direct_light(const Transport& transport, const Walk& walk,
                                const Surface& surface, const Bsdf& bsdf, bool apart,
                                Sampler& sampler);
// Does the same for a Lambertian surface, its lobe's reflectance left out. The walk's wavelengths
// were told of the surface (reflect).
DirectLight sample_direct_light(const Transport& transport, const Walk& walk,
                                const SurfacePlace& place, const LambertLobe& lobe, bool apart,
                                Sampler& sampler);

// Returns the share of light left after a length of the solid it runs in (Beer's law); -1: in none.
vec3 eval_tint(const Transport& transport, int medium, float length);
inline vec3 eval_absorption(const Transport& transport, int medium, float length) {
  return medium < 0 || !transport.tables.any_tint ? vec3(1) : eval_tint(transport, medium, length);
}

// met_lambertian() returns whether the shortest way through the shading suffices.
inline const MaterialTraits& traits_of(const Transport& transport, const Hit& hit) {
  return transport.tables.materials[size_t(transport.world.mesh_of(hit.instance).material)];
}
inline bool met_lambertian(const Transport& transport, const Hit& hit) {
  return traits_of(transport, hit).lambertian;
}

// Traces whole samples for the trace functions of techniques. A sample is the same alone and among
// others.
void trace_samples(const Transport& transport, const WalkRules& rules,
                   std::span<const Request> requests, std::span<Sample> samples);
// Traces one sample in the way that handles all materials, if trace_samples has none quicker.
Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request);
Sample trace_sample(const Transport& transport, const WalkRules& rules, const Request& request,
                    const Hit& first_hit);

}  // namespace wellspring::light
