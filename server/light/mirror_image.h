// SPDX-License-Identifier: Apache-2.0
// Where the image lies that a mirror or polished metal shows: the distance along the ray at which a
// place would look as if it stood still when the eye moves a little. Behind a plane mirror that is
// the length of the way; behind a curved one it follows from how the rays beside it spread (ray
// differentials: Igehy 1999, "Tracing Ray Differentials", here by finite differences).
#pragma once
#include "light/walk.h"

namespace wellspring {

// Mirrors, glass and polished metal: what is seen there moves with the view.
bool looks_specular(const Bsdf& bsdf);

// Of the image that the walk, which begins at the eye and meets `hit` first, is shown by the
// stronger of what each specular surface does: reflect or refract. 0: there is none before the eye,
// or the eye sees through glass, whose outline a place behind it would leave. Deterministic; a few
// rays for each specular surface on the way.
float find_image_distance(const Transport& transport, const Walk& begun, const Hit& hit);

}  // namespace wellspring
