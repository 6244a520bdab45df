// SPDX-License-Identifier: Apache-2.0
// What the eye sees first. Clear thin panes are looked through; what is behind them is described in
// the Sample, and one of their mirror images, chosen by how bright it may be, is left to be
// followed.
#pragma once
#include "light/walk.h"

namespace wellspring {

struct FirstSurface {
  bool scatters = false;  // there is a surface, it is not unlit, and edges are left
  Walk walk;              // that met it
  Surface surface;
  Bsdf bsdf;
  vec3 tint{1};  // by panes and by what the ray ran in
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

// What of a first surface's reflectance is kept apart as Sample::albedo: the diffuse layer's, else
// a soft metal's.
inline constexpr float least_kept_metal = 0.02f;      // of every channel
inline constexpr float least_soft_roughness = 0.346f;
struct KeptReflectance {
  vec3 albedo{0};
  bool diffuse = false;  // has a diffuse layer
  bool soft = false;     // its gloss is rough enough to be filtered with the diffuse light
};
KeptReflectance kept_reflectance(const Bsdf& bsdf);
// The same of an opaque surface whose gloss is alike all around, without asking for its Bsdf.
KeptReflectance kept_reflectance(const Surface& surface);
KeptReflectance kept_reflectance(vec3 base_color, float metallic, float roughness);

}  // namespace wellspring
