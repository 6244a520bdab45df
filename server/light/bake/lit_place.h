// SPDX-License-Identifier: Apache-2.0
// Places whose diffuse light is sampled: a white Lambertian surface but for its coat.
#pragma once
#include "light/bake/bake_scene.h"
#include "light/material/bsdf.h"
#include "world/surface.h"

namespace wellspring::light {

struct BakePlace {
  Surface surface;
  Bsdf bsdf;
  float uncoated = 1;  // what undoes the coat's darkening towards the viewer
};

// The place that a ray meets, as its mesh and its map of normals make it face.
BakePlace light_seen_place(const BakeScene& scene, const Ray& ray, const Hit& hit);
// The same as it faces along `normal`, unit; along its mesh's where that is 0 or the face does not
// show that way. What a map of normals adds is finer than nodes.
BakePlace light_node_place(const BakeScene& scene, const Ray& ray, const Hit& hit, vec3 normal);

// The ray over the cosine that leaves the place. False: none does.
bool leave(const BakePlace& lit, Sampler& sampler, Walk& walk);

// A light that one walk in thousands comes upon (the sun in a brass knob) would stay a spark on the
// wall for hours: gathered light, of all parts together, is cut off at a multiple of the mean.
void cut_off(const BakeScene& scene, std::span<vec3> light);

}  // namespace wellspring::light
