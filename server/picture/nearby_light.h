// SPDX-License-Identifier: Apache-2.0
// The light of a place on a surface so narrow that no cell stands for it: told by the points around
// that lie on the same surface.
#pragma once
#include "frame/frame.h"
#include "picture/cells.h"
#include "world/view.h"

namespace wellspring::picture {

// What is seen at one place of a picture.
struct SeenPlace {
  int x = 0, y = 0;           // the light's pixel that it falls in
  vec2 ray{0};                // to it, in view coordinates (right, up; forward is 1)
  float depth = 0;            // along the viewing axis
  vec3 normal{0}, albedo{0};  // the normal need not be unit
  uint32_t object = 0;
};
struct NearbyLight {
  vec3 smooth{0}, rest{0};  // rest for the place's own reflectance
  // Behind that mean (Kish: as many as if they weighed alike), the fewer the farther off they are
  // or the less their surface is the place's; 0: none.
  float samples = 0;
  float deviation = 0;
};

// Looks at the pixels around the place's own in rings, and no farther than where some know it.
// `light`: the packed planes of a picture with these `rays`.
NearbyLight find_light_nearby(const View& view, const PixelRays& rays, const Frame& light,
                              const SeenPlace& place);
// Returns the light of the nearest cells in eight directions that know the place's object,
// whichever way their surfaces face, within 64 pixels: for places that no pixel around tells of.
// `samples`: theirs.
NearbyLight find_light_far(const Cells& cells, const SeenPlace& place);

}  // namespace wellspring::picture
