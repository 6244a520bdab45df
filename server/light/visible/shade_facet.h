// SPDX-License-Identifier: Apache-2.0
// What one pixel sees of the triangle it shows (light/visible/facet.h), pictures averaged over the
// pixel.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "light/visible/facet.h"
#include "light/visible/gloss.h"
#include "light/visible/see_through.h"
#include "light/walk/first_surface.h"
#include "world/texture_pyramid.h"

namespace wellspring::light {

// Pictures with their smaller selves, of all that a scene's reflectance is made of.
struct Pictures {
  const Scene* scene = nullptr;
  std::vector<TexturePyramid> pyramids;  // of each image; empty where none is needed
};

// All cores.
Pictures make_pictures(const Scene& scene);

// A pixel's width in metres on the surface it sees: the root of its area there.
inline float pixel_width(const Facet& f, float distance, float pixel_angle) {
  const float cosine = f.plane_distance / distance;
  return distance * pixel_angle / std::sqrt(std::max(cosine, 0.02f));
}

inline bool emits(const Facet& f) {
  return (f.front || f.material->double_sided) && f.material->emission != vec3(0);
}

// `metal`: its material's; `pixel`: its width on the surface, metres.
PrimaryHit see_facet(const Pictures& pictures, const World& world, const Facet& f,
                     MetalDemodulation metal, const Hit& hit, float pixel);

Gloss see_gloss(const Pictures& pictures, const Facet& f, vec2 barycentric, float pixel);

}  // namespace wellspring::light
