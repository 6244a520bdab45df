// SPDX-License-Identifier: Apache-2.0
// Finds what the eye sees first. Clear thin panes are looked through: the Sample describes what is
// behind them, and one of their mirror images, chosen by how bright it may be, is left to be
// followed.
#pragma once
#include "light/sample/medium.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct FirstSurface {
  bool scatters = false;  // there is a surface, it is not unlit, and edges are left
  Walk walk;              // walk that met the surface
  Hit hit;                // hit at the surface
  Surface surface;
  Bsdf bsdf;
  vec3 tint{1};  // share of light that panes and media before the surface let through
  MetalDemodulation metal = MetalDemodulation::none;  // the surface material's
  bool by_chance = false;  // a volume is seen, whose matter the ray met by chance
  bool mirrored = false;
  // If mirrored, carries what the panes reflect, divided by the chance of the choice.
  Walk reflection;
};

// Fills `sample` with place, normal, object and the light emitted towards the eye. `max_depth` is
// at least 1.
FirstSurface find_first_surface(const Transport& transport, int max_depth, const Request& request,
                                Sampler& sampler, Sample& sample);
// Does the same for a walk along the request's ray whose first hit is known.
FirstSurface find_first_surface(const Transport& transport, int max_depth, const Walk& walk,
                                Hit hit, Sampler& sampler, Sample& sample);
// Returns the walk that begins with the request's ray.
Walk begin_walk(const Transport& transport, const Request& request);
// Describe in a sample the place where it ended, or the sky if it met nothing.
void describe_place(const World& world, const Hit& hit, const SurfacePlace& place, vec3 normal,
                    float distance, Sample& sample);
// Finds a volume that the eye sees before `t_end` on the walk's ray, if the transport sees volumes,
// and describes the place in the sample; returns whether there is one. `tint` and `distance` are of
// what lies before the ray.
bool see_volume(const Transport& transport, const Walk& walk, float t_end, vec3 tint,
                float distance, Sample& sample);
void describe_sky(const Transport& transport, vec3 direction, vec3 tint, Sample& sample);

inline constexpr float least_albedo = 1e-4f;  // a surface with less has no diffuse layer

// A part of a first surface's reflectance is kept apart as Sample::albedo: the diffuse layer's, and
// that of metal if the material is nothing else (MetalDemodulation). If paint and bare metal are
// one material, the metal's reflection is no part of their common light. So no threshold lies
// within the values of a texture, on whose sides neighbours would be lit differently.
inline constexpr float least_demodulated_metal = 0.02f;  // least of each channel, times metallic
inline constexpr float least_soft_roughness = 0.346f;
struct DemodulatedReflectance {
  vec3 albedo{0};
  vec3 diffuse_share{1};  // the diffuse layer's share of the albedo
  bool diffuse = false;   // the surface has a diffuse layer
  // Shares of gloss that are filtered with the diffuse light, as gloss looks nearly the same from
  // everywhere: of gloss from lights, and from all else.
  float lit_gloss = 0, other_gloss = 0;
};
DemodulatedReflectance demodulated_reflectance(const FirstSurface& first);
// Returns its albedo for an opaque surface whose gloss is alike all around, without the Bsdf.
vec3 demodulated_albedo(vec3 base_color, float metallic, MetalDemodulation metal);
inline vec3 demodulated_albedo(const Surface& surface, MetalDemodulation metal) {
  return demodulated_albedo(surface.base_color, surface.metallic, metal);
}

}  // namespace wellspring::light
