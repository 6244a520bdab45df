// SPDX-License-Identifier: Apache-2.0
// Follows rays of the technique `instant_radiosity` that start at the eye: its mirror images, and
// light that is left for a ray at a place lit by point lights (the list of paths in
// instant_radiosity.h).
#pragma once
#include <span>
#include <vector>

#include "light/sample.h"
#include "light/sample/lights.h"
#include "light/transport_settings.h"
#include "light/virtual/instant_pass.h"
#include "light/virtual/point_light_shading.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct EyeLight {
  const Transport& transport;
  const InstantPass& pass;
  int max_depth = 8;
  int set = 0;  // set of this pixel
};

// Makes `bsdf` the hero wavelength's if the surface that `walk` met parts colours; `bsdf` then
// refers to `spread`.
void part_seen_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                      Sampler& sampler, Bsdf& bsdf, std::optional<WavelengthSpread>& spread);

// Returns the radiance that comes along a walk which left a sharp lobe (or a pane), times its
// throughput.
vec3 follow_mirrors(const EyeLight& eye, Walk walk, Sampler& sampler);

// Returns the radiance that point lights leave out along a walk which left a rough lobe: from
// nearer than the clip distance the share that clipping took, and the light of rough surfaces seen
// through sharp things.
vec3 gather_along(const EyeLight& eye, Walk walk, Sampler& sampler);

// Adds what point lights leave out: what clipping took, and rough light seen in sharp things.
void gather_rest(const EyeLight& eye, const LitPlace& place, Sampler& sampler, PlaceLight& light);

// Takes the shortest way through `instant_radiosity`: Lambertian places that the eye sees first,
// whose light is one irradiance, are computed side by side from the eye's ray to the last light.

// Answers the requests that see something Lambertian, or nothing; returns the numbers of the
// others. Not for passes with caustics, where more may be seen from a Lambertian place than point
// lights.
std::vector<uint32_t> trace_lambert_hits(const Transport& transport, const InstantPass& pass,
                                         int max_depth, std::span<const Request> requests,
                                         std::span<Sample> samples);

// Names the pixels of a pass that ask the same lights.
struct PixelGroup {
  int region = -1, list = 0;
};
PixelGroup group_of_pixel(const InstantPass& pass, uint32_t pixel);
// Sorts items by group, and by number within a group.
class GroupOrder {
 public:
  void add(PixelGroup group, uint32_t item);
  void sort();
  size_t size() const { return keys_.size(); }
  // Takes items of one group from `begin` on, at most `most`; returns how many.
  size_t take(size_t begin, size_t most, uint32_t* items, PixelGroup& group) const;

 private:
  std::vector<uint64_t> keys_;
};

// Answers requests by the point lights and photons of a pass that has begun
// (light/virtual/instant_pass.h): the trace functions of technique `instant_radiosity`
// (light/technique/technique.h).

Sample trace_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                     const Request& request);
void trace_many_instant(const World& world, const Lights& lights, const TransportSettings& settings,
                        std::span<const Request> requests, std::span<Sample> samples);

}  // namespace wellspring::light
