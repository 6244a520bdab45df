// SPDX-License-Identifier: Apache-2.0
// An object looked at from all sides, as if it were lifted out of its case: the eye goes round it,
// what stands before it is cut away, and it keeps the light of its place. The visitor stays where
// they stand meanwhile.
#pragma once
#include "show/exhibit/exhibit.h"
#include "world/world.h"

namespace wellspring::show {

struct Around {
  int point = -1;       // index into Exhibit::points; -1: nothing
  bool leaves = false;  // goes back to where the visitor stands
  float share = 0;      // of the way there: 0 is where the visitor stands, 1 round the object
  dvec3 centre{0};      // absolute
  double radius = 0;    // metres, of a sphere around it
  double distance = 0, wanted_distance = 0;  // of the eye from the centre, metres
  vec2 look{0}, wanted_look{0};              // yaw and pitch of the eye, which looks at the centre
  Viewpoint view;                            // as it is seen
  float near = 0;                            // View::near
};

// Of all that belongs to the object as it stands now, relative to the scene's origin; empty: low
// above high.
Bounds object_bounds(const World& world, const PointOfInterest& point);

// From the side of which it is seen from `from`. `aspect`: the picture's width over its height.
void begin_around(const Exhibit& exhibit, int point, const Bounds& bounds, const Viewpoint& from,
                  float aspect, Around& around);
// Turns it by `look`, as a visitor's head turns by that.
void turn_around(vec2 look, Around& around);
// Moves on by `dt` seconds, nearer by `forward` metres a second of its own size. `from`: where the
// visitor stands; `leaps`: at once. It ends by itself once it has gone back.
void advance_around(const Viewpoint& from, float forward, bool leaps, float dt, Around& around);

}  // namespace wellspring::show
