// SPDX-License-Identifier: Apache-2.0
// What the eye sees first. Clear thin panes are looked through; what is behind them is described in the
// Sample, and one of their mirror images, chosen by how bright it may be, is left to be followed.
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
  Walk reflection;  // if mirrored: carries what the panes reflect, divided by the chance of the choice
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

}  // namespace wellspring
