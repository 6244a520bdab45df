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
inline constexpr float sharp_alpha = 0.1f;

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

}  // namespace wellspring::light
