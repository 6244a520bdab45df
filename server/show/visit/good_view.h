// SPDX-License-Identifier: Apache-2.0
// Finds what a visitor points at in its picture, and from where an object is seen well: from ground
// that can be walked to, with all of the object in the picture and nothing before it.
#pragma once
#include <optional>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/visit/walk_map.h"
#include "world/view.h"

namespace wellspring::show {

// Returns the first surface along a ray that is neither glass nor a storyteller.
Hit first_solid(const World& world, Ray ray);

struct Pointed {
  vec3 place{0};   // place on the surface, relative to the scene's origin
  vec3 ground{0};  // ground below it, on the side from which it was seen
  int point = -1;  // index into Exhibit::points of the one that it belongs to
};

// Returns what lies at `at` in the picture, 0 to 1 from its upper left. Objects count that are a
// finger's width away, unless it is ground. Nothing: there is nothing to be seen.
std::optional<Pointed> point_at(const Exhibit& exhibit, const World& world, const View& view,
                                vec2 at);

// Returns the view from one of `places` that shows object `point` best, and as near as may be to
// the way that `from` looks at it. `near`: the part that is meant of a thing of many parts, if that
// is larger than can be seen at once. `aspect`: the picture's width over its height; `fov`: the
// widest, radians. Nothing: it cannot be seen from anywhere.
std::optional<Viewpoint> good_view(const Exhibit& exhibit, const World& world, const WalkMap& map,
                                   const std::vector<int>& places, int point,
                                   std::optional<vec3> near, const Viewpoint& from, float aspect,
                                   float fov);

}  // namespace wellspring::show
