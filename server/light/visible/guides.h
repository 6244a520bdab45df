// SPDX-License-Identifier: Apache-2.0
// Guides of a picture's reconstruction (denoise/denoise.h): what is known of each pixel without
// noise. Albedo is the share of light that leaves where the eye looks, diffuse and glossy
// reflection together; light sources and the sky count with their own colour, at most white. The
// normal is the shading normal, in world space, 0 in the sky. Of what is polished the ray is
// followed to what that mirrors or lets through, by the share of light this is; mirrors, glass and
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

// Of what rays from the eye show; no chance is involved. guides[i] answers rays[i]. All cores.
void eval_guides(const World& world, const Lights& lights, std::span<const Ray> rays,
                 std::span<Guide> guides);

struct GuidePlanes {
  std::vector<vec3> albedo, normal;  // of each pixel, row after row; normals are shorter at edges
};
// Means over `rays` rays a pixel, spread evenly over it. All cores.
GuidePlanes make_guides(const World& world, const Lights& lights, const View& view, int rays = 16);

// What rays from the eye meet, without the light that falls there: for pictures whose light is
// known from elsewhere. A twentieth of a sample's cost.

// As in the Sample a technique would give for the same ray, panes looked through.
struct PrimaryHit {
  vec3 normal{0};      // unit; towards the eye where nothing was hit
  float distance = 0;  // along the ray; infinity: nothing was hit
  vec3 albedo{0};
  vec3 glow{0};  // emission and sky: what is there of Sample::rest without any light falling
  uint32_t object = 0;
  bool scatters = false;  // else `glow` is all there is
};

// seen[i] answers rays[i]; neighbours side by side are quickest. All cores.
void see(const World& world, const Lights& lights, std::span<const Ray> rays,
         std::span<PrimaryHit> seen);

}  // namespace wellspring::light
