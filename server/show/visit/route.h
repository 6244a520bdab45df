// SPDX-License-Identifier: Apache-2.0
// Finds a way on foot from one place to another, around what stands there: A* over the walk map
// (Hart, Nilsson, Raphael 1968) that prefers room, pulled straight and smoothed as an elastic band
// (Quinlan & Khatib 1993) that never comes nearer to anything than the visitor's radius.
#pragma once
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/visit/walk_map.h"

namespace wellspring::show {

struct Route {
  std::vector<vec3> points;  // on the ground, some 0.15 m apart, the ends included; empty: no way
  std::string problem;       // why there is no way, and where it ends
};

// Finds a route. Both ends are eyes, relative to the scene's origin; an end may stand nearer to
// things than the radius (people lean over), by at most `lean` metres from where the way is free.
inline constexpr float lean = 0.45f;
Route find_route(const WalkMap& map, vec3 from, vec3 to);

// Returns the places of the map that can be walked to from an eye; all of them if it stands nowhere
// itself.
std::vector<int> reachable_places(const WalkMap& map, vec3 eye);
// Returns which of these is nearest to a point on the ground; -1: there are none.
int nearest_of(const WalkMap& map, const std::vector<int>& places, vec3 ground);

}  // namespace wellspring::show
