// SPDX-License-Identifier: Apache-2.0
// The light that reaches a picture's surfaces straight from lights that move or change, by a shadow
// ray a pixel and light, sixteen neighbours at once.
#pragma once
#include <span>

#include "base/raw_vector.h"
#include "light/dynamic/dynamic_light.h"
#include "light/sample/lights.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {

// Of each pixel of a SurfaceBuffer the radiance of a white diffuse surface: irradiance over pi; and
// that of its highlights, which are empty where nothing has any.
struct LightPlanes {
  RawVector<float> red, green, blue;
  RawVector<float> gloss_red, gloss_green, gloss_blue;
};
size_t memory_bytes(const LightPlanes& planes);
void clear_planes(const SurfaceBuffer& surfaces, LightPlanes& planes);

// Adds that of `dynamic`. Thin panes tint what passes them, everything else is a shadow. A surface
// that a light touches gets no more than from `least_distance` metres away. Highlights are those of
// a light as large as its radius says, and of surfaces no smoother than `least_alpha`: a point in a
// mirror would be a spark. `lights` tells panes.
// All cores; call after World::commit(), while nothing moves.
inline constexpr float least_distance = 0.05f, least_alpha = 0.04f;
void add_direct_light(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                      const SurfaceBuffer& surfaces, LightPlanes& to);

}  // namespace wellspring::light
