// SPDX-License-Identifier: Apache-2.0
// How a visitor gets about: walls stop, floors carry, stairs are climbed, bounds hold. Rays against
// the world decide; a visitor inside a wall is not trapped there.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/problem.h"
#include "world/world.h"

namespace wellspring::show {

// The place after moving from `position` (absolute) with `velocity` (metres a second, world axes)
// for `dt` seconds (0 to 0.25; longer steps are cut). With no rules: free flight.
dvec3 walk(const World& world, const std::optional<WalkSettings>& rules, dvec3 position,
           vec3 velocity, float dt);

// Round somebody whom nobody comes nearer than `distance` on the ground (the innermost glass wall
// of the storyteller and kiosk paper): a step from `from` to `to` ends on the circle instead of
// within it, slid along; who stands within already may only go outwards.
inline constexpr double nearest_to_storyteller = 0.9;  // metres
dvec3 keep_distance(dvec3 from, dvec3 to, dvec3 centre, double distance = nearest_to_storyteller);

// A note of every viewpoint with no ground under it, from which nobody who walks could take a step.
void check_ground(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// Velocity in world axes of `move` = [right, up, forward] for a visitor looking along `yaw`.
vec3 move_direction(vec3 move, float yaw);

}  // namespace wellspring::show
