// SPDX-License-Identifier: Apache-2.0
// What the eye sees first. Clear thin panes are looked through; what is behind them is described in
// the Sample, and one of their mirror images, chosen by how bright it may be, is left to be
// followed.
#pragma once
#include "light/sample/medium.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct FirstSurface {
  bool scatters = false;  // there is a surface, it is not unlit, and edges are left
  Walk walk;              // that met it
  Hit hit;                // where
  Surface surface;
  Bsdf bsdf;
  vec3 tint{1};                                       // by panes and by what the ray ran in
  MetalDemodulation metal = MetalDemodulation::none;  // its material's
  bool mirrored = false;
  Walk reflection;  // if mirrored: carries what the panes reflect, divided by the chance of the
                    // choice
};

// Fills `sample` with place, normal, object and what is emitted towards the eye. At least one edge.
FirstSurface find_first_surface(const Transport& transport, int max_depth, const Request& request,
                                Sampler& sampler, Sample& sample);
// The same, of a walk along the request's ray whose first hit is known.
FirstSurface find_first_surface(const Transport& transport, int max_depth, const Walk& walk,
                                Hit hit, Sampler& sampler, Sample& sample);
// The walk that begins there.
Walk begin_walk(const Transport& transport, const Request& request);
// What a sample says of the place where it ended, and of having met nothing.
void describe_place(const World& world, const Hit& hit, const SurfacePlace& place, vec3 normal,
                    float distance, Sample& sample);
void describe_sky(const Transport& transport, vec3 direction, vec3 tint, Sample& sample);

inline constexpr float least_albedo = 1e-4f;  // below it nothing is diffuse

// What of a first surface's reflectance is kept apart as Sample::albedo: the diffuse layer's, and
// of metals that of materials which are nothing else (MetalDemodulation). Where paint and bare
// metal are one material, what metal reflects is none of their common light. So no threshold lies
// within what a texture says, on whose sides neighbours would be lit differently.
inline constexpr float least_demodulated_metal = 0.02f;  // of every channel, by how metallic it is
inline constexpr float least_soft_roughness = 0.346f;
struct DemodulatedReflectance {
  vec3 albedo{0};
  vec3 diffuse_share{1};  // of it
  bool diffuse = false;   // has a diffuse layer
  // Of gloss, how much is filtered with the diffuse light, as it looks nearly the same from
  // everywhere: of what lights give, and of all else.
  float lit_gloss = 0, other_gloss = 0;
};
DemodulatedReflectance demodulated_reflectance(const FirstSurface& first);
// Its albedo, of an opaque surface whose gloss is alike all around, without asking for its Bsdf.
vec3 demodulated_albedo(vec3 base_color, float metallic, MetalDemodulation metal);
inline vec3 demodulated_albedo(const Surface& surface, MetalDemodulation metal) {
  return demodulated_albedo(surface.base_color, surface.metallic, metal);
}

}  // namespace wellspring::light
