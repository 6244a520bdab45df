// SPDX-License-Identifier: Apache-2.0
// Follows light on its way from a source, the other way round from walk.h: flux instead of
// radiance. Scattering is the adjoint of what the eye sees (Veach 1997, sections 5.2 and 5.3:
// squared indices at refraction, shading normals), so that both ways agree on every path.
//
// A scattering is `sharp` if a lobe smoother than caustic_roughness did it. Sharp and rough
// scatterings are kept apart so that each path of light is found by one technique only.
#pragma once
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"
#include "light/walk/walk.h"

namespace wellspring::light {

inline constexpr float sharp_alpha = caustic_roughness * caustic_roughness;
// The roughest lobe that the eye follows as a mirror; may differ from sharp_alpha, since no path is
// sorted by it.
inline constexpr float mirror_alpha = 0.25f;

float smoothest_alpha(const Bsdf& bsdf);
bool has_blurred(const Bsdf& bsdf);  // some specular lobe has a density
// Returns whether the specular lobes belong to the sharp ones: one of them is smoother than
// `alpha`.
bool has_sharp(const Bsdf& bsdf, float alpha);
// Returns whether something besides the sharp lobes scatters.
bool has_rough(const Bsdf& bsdf, float alpha);

struct LightWalk {
  Ray ray;
  vec3 flux{0};
  int depth = 1;  // this ray's number, counted from the source, without what solid glass did
  int glass = 0;  // edges that solid glass did
  // Media that the ray runs in, found where it starts, and beyond the surface it met last.
  Media media;
  int panes = 0;
  float run = 0;  // metres since the source or the last scattering, panes looked through
  float range = std::numeric_limits<float>::infinity();  // range of the source, for the first ray
  // Set once the walk has met something dispersive; `flux` has their colour.
  Wavelengths wavelengths;
  int edges() const { return depth + glass; }
};

struct Arrival {
  Surface surface;
  Bsdf bsdf;         // its view is where the light comes from
  vec3 flux{0};      // flux that arrives
  bool lit = false;  // the surface scatters at all
};

// Finds where the ray ends; returns false if it ends nowhere, or carries no light.
bool arrive(const Transport& transport, LightWalk& walk, Arrival& arrival);

// Sends the walk on by a sample of sample_bsdf(arrival.bsdf); returns false if it ends, which it
// does at random so that what goes on is as bright as what came.
bool scatter(LightWalk& walk, const Arrival& arrival, const BsdfSample& scattered,
             Sampler& sampler);

// Makes `arrival.bsdf` that of the wavelength that leads from here, if the surface parts colours.
void part_arrival(const Transport& transport, const LightWalk& walk, Sampler& sampler,
                  Arrival& arrival, std::optional<WavelengthSpread>& spread);
// Sends the walk on by a sample of some lobes; `spread`: part_arrival's.
bool scatter(LightWalk& walk, const Arrival& arrival, const std::optional<WavelengthSpread>& spread,
             Lobes lobes, Sampler& sampler);

// Returns the intensity that a flux of 1 leaves towards a direction, by the rough lobes.
vec3 eval_scattered(const Arrival& arrival, vec3 direction);

}  // namespace wellspring::light
