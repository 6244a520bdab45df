// SPDX-License-Identifier: Apache-2.0
// Follows what a ray runs in: the solids of glass and liquid that it has entered and not left. In
// several, the one entered last counts, so a solid inside another displaces it and partly
// overlapping ones need no rank (glTF has none; an overlap belongs to the solid entered last).
// Entering the same material twice nests; leaving takes away the latest of its material, whichever
// instance it is.
//
// Faces so close together that a ray's next origin lies beyond all of them (liquid that touches its
// glass, blocks put together) are one boundary, between what lies before the first and behind the
// last; if one of them is opaque, the ray ends there.
//
// Scenes without solids (TransportPart::refraction) pay one branch at each hit.
#pragma once
#include "light/material/bsdf_types.h"
#include "world/world.h"

namespace wellspring::light {

struct Transport;

// Holds materials, the outermost first. Beyond `most` the outermost is forgotten.
struct MediumStack {
  static constexpr int most = 4;
  int count = 0;
  int material[most];
  int innermost() const { return count > 0 ? material[count - 1] : -1; }
};
void enter_solid(MediumStack& stack, int material);
void leave_solid(MediumStack& stack, int material);  // does nothing if it was never entered

// Holds the media of a ray that met a surface: before the surface, and on its other side.
struct Media {
  MediumStack here, beyond;
};
// Returns the innermost solid on the side of `place` that `direction` points to, -1: none.
inline int medium_towards(const Media& media, const SurfacePlace& place, vec3 direction) {
  return (dot(direction, place.geometric_normal) < 0 ? media.beyond : media.here).innermost();
}

// Returns the solids around a place, found by rays in several directions that must agree: solids
// that they leave without having entered them are around their start. Each thread remembers the
// last place asked for. Solids that move are not looked for: a ray notices them when it leaves
// them.
MediumStack find_media(const Transport& transport, vec3 place);

// Returns the surface at a valid hit. `media.here` gains a solid that the ray turns out to have
// started in, and `media.beyond` is set. `hit` changes if an opaque face coincides with that of a
// solid.
Surface meet_surface(const Transport& transport, const Ray& ray, Hit& hit, Media& media);

// Calls make_bsdf with the indices on both sides. An opaque surface that is less dense than the
// medium has no gloss in it; thin panes are as if in air.
Bsdf make_bsdf_in(const Transport& transport, const Media& media, const Surface& surface,
                  const Material& material, vec3 direction);
// Returns the index on the side of a solid's surface that is not the solid's own.
float index_outside(const Transport& transport, const Media& media, const Surface& surface);
// Returns whether the boundary is the solid's own: no other displaces it where it lies.
bool owns_boundary(const Media& media, const Surface& surface);

}  // namespace wellspring::light
