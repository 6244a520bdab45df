// SPDX-License-Identifier: Apache-2.0
// Judges a bake at places that no node is sampled for. Each is sampled in two halves a and b that
// are independent of each other and of the map m, so the mean of (a - m)(b - m) is the map's mean
// square error, whatever the samples' noise: details that its nodes are too coarse for count, maps
// of normals too. (Cross-validation by independent halves.)
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/kept/bake_scene.h"
#include "light/kept/charts.h"
#include "light/material/bsdf.h"
#include "world/surface.h"

namespace wellspring::light {

// Finds places whose diffuse light is sampled: a white Lambertian surface but for its coat.

struct BakePlace {
  Surface surface;
  Bsdf bsdf;
  float uncoated = 1;  // factor that undoes the coat's darkening towards the viewer
};

// Returns the place that a ray meets, facing as its mesh and its map of normals have it.
BakePlace light_seen_place(const BakeScene& scene, const Ray& ray, const Hit& hit);
// Returns the same place facing along `normal`, unit; along the mesh's normal if `normal` is 0 or
// the face does not look that way. Details that a map of normals adds are finer than nodes.
BakePlace light_node_place(const BakeScene& scene, const Ray& ray, const Hit& hit, vec3 normal);

// Lets a ray over the cosine leave the place; returns false if none does.
bool leave(const BakePlace& lit, Sampler& sampler, Walk& walk);

// Cuts off gathered light, of all parts together, at a multiple of the mean: a light that one walk
// in thousands comes upon (the sun in a brass knob) would stay a spark on the wall for hours.
void cut_off(const BakeScene& scene, std::span<vec3> light);

struct HeldOutPlace {
  Ray ray;  // towards the place, from its lit side
  Hit hit;
  uint32_t chart = 0;
  vec3 position{0}, mesh{0}, seen{0};  // normals: the mesh's, and with its map of normals
  float half[2] = {0, 0};              // sums of the samples' luminance
};

struct HeldOut {
  std::vector<HeldOutPlace> places;
  uint32_t samples = 0;  // samples of each half
};

// Returns about `count` places as they are seen by eyes at `eyes` (scene coordinates) that look
// about level; without any eyes, evenly over all charts.
HeldOut hold_out(const World& world, const BakeCharts& charts, std::span<const vec3> eyes,
                 size_t count, uint64_t seed);
// Finds anew what follows from the rays and hits of places that were read from a file. Returns
// false if they are not places of the world.
bool restore(const World& world, const IlluminationCharts& charts, HeldOut& held);
// Adds that many samples to either half. Uses all cores.
void sample_held_out(const BakeScene& scene, int samples, HeldOut& held);

// Returns the map's root mean square error over the mean light; a standard error of the mean square
// is added, so that few samples do not flatter. 1 without samples; without light 0, or 1 if the map
// has some.
float held_out_error(const HeldOut& held, const IlluminationMap& map);

}  // namespace wellspring::light
