// SPDX-License-Identifier: Apache-2.0
// A first surface's diffuse light, as an illumination map knows it.
#pragma once
#include "light/sample/illumination_map.h"
#include "light/walk/walk.h"

namespace wellspring {

struct KnownLight {
  bool known = false;
  vec3 light{0};  // Sample::smooth times Sample::known, of a surface without a coat
  vec3 unit{1};   // Sample::known
};
// Of what a ray has met at `position` in air.
KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            vec3 position);
// Whether something that moves may change the light there by more than a little: it is near, or
// close to the way from a punctual light.
bool may_be_shaded(const Transport& transport, vec3 position);

// Light as a multiple of the known: a little is added to both, so that the dark has no noise.
inline vec3 in_units(const Transport& transport, const KnownLight& known, vec3 light) {
  return (light + vec3(transport.maps->least_known())) / known.unit;
}

}  // namespace wellspring
