// SPDX-License-Identifier: Apache-2.0
// Things that walk through a lawn, and how deep a place is within them. Capsules stand for feet,
// legs and a visitor's body; depth cubes for meshes.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "lawn/depth_cube.h"

namespace wellspring::lawn {

// Holds all that is within `radius` of the line from `a` to `b`; a sphere if they are the same.
struct Capsule {
  vec3 a{0}, b{0};
  float radius = 0;  // metres; 0 or less: it touches nothing
};

// A mesh that has been moved and turned.
struct PlacedCube {
  const DepthCube* cube = nullptr;  // borrowed; null: none
  vec3 place{0};                    // here is the mesh's origin
  mat3 turn{1};                     // a rotation
};

// Holds all that walks at one tick. Those that are not finite are left out.
struct Walkers {
  std::vector<Capsule> capsules;
  std::vector<PlacedCube> cubes;
};

// One collider of either kind, checked, with the box around it.
struct Collider {
  Capsule capsule;
  const DepthCube* cube = nullptr;  // null: it is the capsule
  vec3 place{0};
  mat3 turn{1};
  vec3 low{0}, high{0};
  float margin = 0;  // metres that pushed places are beyond the surface, for rounding
};
std::vector<Collider> find_colliders(const Walkers& walkers);

// Returns how far the place is from the surface, below 0 inside; of a cube as it measures.
float distance_to(const Collider& collider, vec3 v);

// Moves the places of `lanes` that lie inside out of the collider, and returns which do: a place v
// moves by |d(v)| along the unit normal (Orthmann and others, equations 4 and 5, in which s holds
// the normal already and d has the wrong sign for a way out). If a cube is not convex this may not
// suffice; then a place moves along the axis by which d was found, which always does.
LaneMask push_out(const Collider& collider, const LaneMask& lanes, Lanes3& v);

}  // namespace wellspring::lawn
