// SPDX-License-Identifier: Apache-2.0
// How a visitor gets about: walls stop, floors carry, stairs are climbed, bounds hold. Rays against the
// world decide; a visitor inside a wall is not trapped there.
#pragma once
#include "show/exhibit.h"
#include "world/bvh.h"

namespace wellspring {

// The place after moving from `position` (absolute) with `velocity` (metres a second, world axes) for `dt`
// seconds (0 to 0.25; longer steps are cut). With no rules: free flight.
dvec3 walk(const World& world, const std::optional<WalkRules>& rules, dvec3 position, vec3 velocity, float dt);

// Velocity in world axes of `move` = [right, up, forward] for a visitor looking along `yaw`.
vec3 move_direction(vec3 move, float yaw);

}  // namespace wellspring
