// SPDX-License-Identifier: Apache-2.0
// Computes the light that reaches a picture's surfaces straight from lights that move or change, by
// a shadow ray a pixel and light, sixteen neighbours at once.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/memory.h"
#include "light/sample/lights.h"
#include "light/visible/surface_buffer.h"
#include "world/scene.h"

namespace wellspring::light {

// Describes lights that move or change while an exhibit runs: a torch that is carried, a fire that
// flickers, the sun over a day. They are no part of Lights: no light that is kept or baked contains
// theirs. Light adds up, so theirs is computed for each picture and added to that of what stands
// still.

struct DynamicLight {
  PunctualLight light;  // as it is at the moment, relative to Scene::origin
  uint32_t id = 0;      // unique; the same from picture to picture
  float radius = 0;     // metres around it in which nothing casts a shadow: its flame casts none
};

// Holds the lights of a visitor's pictures, black ones left out.
using DynamicLights = std::vector<DynamicLight>;

// Reads light of half of a picture's resolution between four of its pixels, each of which counts as
// far as it shows the same surface.

// Pictures of more pixels get light of half their resolution: pictures that stay, and pictures that
// are soon followed by the next.
inline constexpr size_t fine_dynamic_pixels = 320 * 1024, passing_dynamic_pixels = 64 * 1024;
inline constexpr int light_scale = 2;  // pixels of such a picture a side of one pixel of its light
// Returns the view in which light for pictures of `view` is computed.
inline View dynamic_light_view(const View& view, size_t fine = fine_dynamic_pixels) {
  if (size_t(view.width) * size_t(view.height) <= fine) return view;
  View light = view;
  light.width = (view.width + light_scale - 1) / light_scale;
  light.height = (view.height + light_scale - 1) / light_scale;
  light.tan_half_fov = view.tan_half_fov * float(light.height * light_scale) / float(view.height);
  return light;
}

// Holds the two pixels of the light around the middle of pixel `at` of a picture's row or column,
// and the share of the way from the first to the second.
struct TapPair {
  int first, second;
  float share;
};
inline TapPair tap_pair(int at, int size) {
  static_assert(light_scale == 2);
  const int left = (at + 1) / 2 - 1;
  return {std::max(left, 0), std::min(left + 1, size - 1), at % 2 ? 0.25f : 0.75f};
}

// Holds the point that a pixel of the picture shows.
struct SeenPoint {
  vec3 place{0}, normal{0};  // relative to the eye; unit, or 0
  float depth = 0;
  uint32_t object = 0;
};
// Returns it. `way`: from the eye to the pixel, at depth 1.
inline SeenPoint seen_point(float depth, uint32_t object, const RunSurface& surface, int i,
                            vec3 way) {
  SeenPoint seen{depth * way, {surface.nx[i], surface.ny[i], surface.nz[i]}, depth, object};
  const float length2 = dot(seen.normal, seen.normal);
  if (length2 > 0) seen.normal /= std::sqrt(length2);
  if (!(depth < std::numeric_limits<float>::infinity())) seen.place = vec3(0);
  return seen;
}
// Holds weights of the four pixels of the light around a point, row by row: bilinear weights times
// how much each shows the same surface; if none does, the most alike alone counts. They add up to
// 1, or are 0 if nothing is there.
struct TapWeights {
  float of[4] = {};
};
TapWeights weigh_taps(const SurfaceBuffer& light, const PixelGrid& grid, const TapPair& x,
                      const TapPair& y, const SeenPoint& seen);

// Holds for each pixel of a SurfaceBuffer the radiance of a white diffuse surface, which is
// irradiance over pi, and the radiance of its highlights; the latter is empty if no surface has
// any.
struct LightPlanes {
  RawVector<float> red, green, blue;
  RawVector<float> gloss_red, gloss_green, gloss_blue;
};
size_t memory_bytes(const LightPlanes& planes);
void clear_planes(const SurfaceBuffer& surfaces, LightPlanes& planes);

// Adds the light of `from`. Thin panes tint what passes them, everything else casts a shadow. A
// surface that a light touches gets no more than from `least_distance` metres away. Highlights are
// those of a light as large as its radius says, and of surfaces no smoother than `least_alpha`: a
// point in a mirror would be a spark. `lights` says which surfaces are panes. Runs on all cores;
// call it after World::commit(), while nothing moves.
inline constexpr float least_distance = 0.05f, least_alpha = 0.04f;
void add_direct_light(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                      const SurfaceBuffer& surfaces, LightPlanes& to);

}  // namespace wellspring::light
