// SPDX-License-Identifier: Apache-2.0
// What a visitor points at in its picture, and from where an object is seen well: from ground that
// can be walked to, with all of it in the picture and nothing before it.
#pragma once
#include <optional>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/visit/walk_map.h"
#include "world/view.h"

namespace wellspring::show {

// The first surface along a ray that is neither glass nor a storyteller.
Hit first_solid(const World& world, Ray ray);

struct Pointed {
  vec3 place{0};   // relative to the scene's origin; of the surface
  vec3 ground{0};  // below it, on the side from which it was seen
  int point = -1;  // index into Exhibit::points: it is part of that one
};

// `at`: of the picture, 0 to 1 from its upper left. Objects count that are a finger's width away,
// unless it is ground. Nothing: there is nothing to be seen.
std::optional<Pointed> point_at(const Exhibit& exhibit, const World& world, const View& view,
                                vec2 at);

// Of those places the view that shows object `point` best, and as near as may be to the way that
// `from` looks at it. `near`: what of a thing of many parts is meant, if that is larger than can be
// seen at once. `aspect`: the picture's width over its height; `fov`: the widest, radians. Nothing:
// it cannot be seen from anywhere.
std::optional<Viewpoint> good_view(const Exhibit& exhibit, const World& world, const WalkMap& map,
                                   const std::vector<int>& places, int point,
                                   std::optional<vec3> near, const Viewpoint& from, float aspect,
                                   float fov);

}  // namespace wellspring::show
