// SPDX-License-Identifier: Apache-2.0
// The light that reaches a picture's surfaces straight from lights that move or change: a shadow
// ray a pixel and light, sixteen neighbours at once.
#pragma once
#include <span>

#include "base/raw_vector.h"
#include "light/dynamic/dynamic_light.h"
#include "light/sample/lights.h"
#include "light/visible/surface_buffer.h"

namespace wellspring {

// Of each pixel of a SurfaceBuffer the radiance of a white diffuse surface: irradiance over pi.
struct LightPlanes {
  RawVector<float> red, green, blue;
};
size_t memory_bytes(const LightPlanes& planes);
void clear_planes(size_t pixels, LightPlanes& planes);

// Adds that of `dynamic`. Thin panes tint what passes them, everything else is a shadow. A surface
// that a light touches gets no more than from `least_distance` metres away. `lights` tells panes.
// All cores; call after World::commit(), while nothing moves.
inline constexpr float least_distance = 0.05f;
void add_direct_light(const World& world, const Lights& lights, std::span<const DynamicLight> from,
                      const SurfaceBuffer& surfaces, LightPlanes& to);

}  // namespace wellspring
