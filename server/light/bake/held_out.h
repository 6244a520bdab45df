// SPDX-License-Identifier: Apache-2.0
// Places that no node is sampled for: at them a bake is judged. Each is sampled in two halves that
// know nothing of each other, nor of the map m, so the mean of (a - m)(b - m) is the mean square of
// what the map is wrong by, whatever the samples' noise: what its nodes are too coarse for counts,
// maps of normals too. (Cross-validation by independent halves.)
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/bake/bake_scene.h"
#include "light/bake/charts.h"
#include "light/material/bsdf.h"
#include "world/surface.h"

namespace wellspring::light {

// Places whose diffuse light is sampled: a white Lambertian surface but for its coat.

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

struct HeldOutPlace {
  Ray ray;  // towards it, from its lit side
  Hit hit;
  uint32_t chart = 0;
  vec3 position{0}, mesh{0}, seen{0};  // normals: of the mesh, and with its map of normals
  float half[2] = {0, 0};              // sums of luminance
};

struct HeldOut {
  std::vector<HeldOutPlace> places;
  uint32_t samples = 0;  // of each half
};

// About `count` places: as eyes at `eyes` (scene coordinates) that look about level see them,
// without any evenly over all charts.
HeldOut hold_out(const World& world, const BakeCharts& charts, std::span<const vec3> eyes,
                 size_t count, uint64_t seed);
// Finds anew what follows from the rays and hits of places that were read from somewhere. False:
// they are none of the world.
bool restore(const World& world, const IlluminationCharts& charts, HeldOut& held);
// Adds that many samples to either half. All cores.
void sample_held_out(const BakeScene& scene, int samples, HeldOut& held);

// Root mean square of what the map is wrong by, over the mean light; a standard error of that is
// added, so that few samples do not flatter. 1 where there are no samples; 0 without light.
float held_out_error(const HeldOut& held, const IlluminationMap& map);

}  // namespace wellspring::light
