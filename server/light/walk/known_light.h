// SPDX-License-Identifier: Apache-2.0
// Diffuse light of surfaces as an illumination map knows it: of a first surface, and of those on
// which walks end.
#pragma once
#include "light/sample/illumination_map.h"
#include "light/material/bsdf_types.h"
#include "light/sample.h"
#include "light/sample/transport.h"

namespace wellspring::light {

struct KnownLight {
  bool known = false;
  vec3 light{0};     // of a surface without a coat
  vec3 unit{1};      // Sample::known
  float raised = 0;  // Sample::raised
};
// The chart of what a ray has met, on the side that it came from; or no_chart.
uint32_t find_chart(const IlluminationCharts& charts, const World& world, const Ray& ray,
                    const Hit& hit);
// Whether a map knows the light of what a ray has met, in air.
bool has_known_light(const Transport& transport, const Ray& ray, const Hit& hit);
// Of what a ray has met at `position` in air, as light falls on the mesh.
KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            vec3 position);
// The same as it falls on the surface's own normal, which a map of normals may have turned.
KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            const Surface& surface);
// Light on which a ray in air may end, as it falls on what that has met (irradiance over pi).
// `sharp`: shadows of what moves would be seen. False: nothing is known there.
bool find_kept_light(const Transport& transport, const Ray& ray, const Hit& hit, bool sharp,
                     vec3& light);
// A surface reflects this share of light that is as bright all around. A sharp gloss is left out:
// walks follow it.
bool has_sharp_gloss(const Bsdf& bsdf);
vec3 kept_reflectance(const Bsdf& bsdf);

// Whether something that moves may change the light there by more than a little: it is near, or
// close to the way from a punctual light.
bool may_be_shaded(const Transport& transport, vec3 position);

// Says in the sample that light is counted in multiples of the known; `light` is what it has
// found. A little is added to both, so that the dark has no noise.
inline void tell_in_units(const KnownLight& known, vec3 light, Sample& sample) {
  sample.known = known.unit;
  sample.raised = known.raised;
  sample.flags |= sample_mapped;
  sample.smooth = (light + vec3(known.raised)) / known.unit;
}

}  // namespace wellspring::light
