// SPDX-License-Identifier: Apache-2.0
// Finds the ground under feet: of meshes by a ray, of scans by their points, which lie closer to
// the surface than the coarse mesh that rays meet in place of them.
#pragma once
#include <optional>

#include "world/world.h"

namespace wellspring::show {

inline constexpr float foot_reach = 0.5f;  // metres above and below the feet where ground is sought

// Returns the height of the ground, relative to the scene's origin, at `feet`, likewise: the
// highest surface within reach. A scan's surface is the median height of its points that are no
// farther than `radius` from the line through the feet, metres. Nothing: there is no ground.
std::optional<float> find_footing(const World& world, vec3 feet, float radius);

}  // namespace wellspring::show
