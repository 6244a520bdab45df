// SPDX-License-Identifier: Apache-2.0
// Makes the guides of a picture's reconstruction (denoise/denoise.h): noiseless values of each
// pixel. Albedo is the share of light that leaves where the eye looks, diffuse and glossy
// reflection together; light sources and the sky count with their own colour, at most white. The
// normal is the shading normal, in world space, 0 in the sky. From polished surfaces the ray is
// followed to what they mirror or let through, by the share of light this is; mirrors, glass and
// polished metal have no normal of their own but that of what they show.
#pragma once
#include <span>
#include <vector>

#include "light/sample/lights.h"
#include "world/view.h"

namespace wellspring::light {

// Surfaces whose facets are sharper than this (alpha of GGX) show a picture of others.
inline constexpr float polished_alpha = 0.1f;

struct Guide {
  vec3 albedo{0};  // 0 to 1
  vec3 normal{0};  // unit towards the viewer, or 0
};

// Computes the guides of what rays from the eye show; no chance is involved. guides[i] answers
// rays[i]. Runs on all cores.
void eval_guides(const World& world, const Lights& lights, std::span<const Ray> rays,
                 std::span<Guide> guides);

struct GuidePlanes {
  // One for each pixel, row after row; normals are shorter at edges
  std::vector<vec3> albedo, normal;
};
// Returns means over `rays` rays a pixel, spread evenly over it. Runs on all cores.
GuidePlanes make_guides(const World& world, const Lights& lights, const View& view, int rays = 16);

// Fetches the pieces of very large pictures that a view shows, also in mirrors and behind glass,
// and returns when they are there: for finished pictures.
void fetch_pieces(const World& world, const Lights& lights, const View& view);

// Finds what rays from the eye meet, without the light that falls there, for pictures whose light
// comes from elsewhere. It costs a twentieth of a sample.

// Holds the same values as the Sample a technique would give for the ray, panes looked through.
struct PrimaryHit {
  vec3 normal{0};      // unit; towards the eye where nothing was hit
  float distance = 0;  // along the ray; infinity: nothing was hit
  vec3 albedo{0};
  vec3 glow{0};  // emission and sky: Sample::rest without any light falling there
  uint32_t object = 0;
  bool scatters = false;  // false: there is only `glow`
};

// Casts the rays: seen[i] answers rays[i]; neighbours side by side are quickest. Runs on all cores.
void see(const World& world, const Lights& lights, std::span<const Ray> rays,
         std::span<PrimaryHit> seen);

}  // namespace wellspring::light
