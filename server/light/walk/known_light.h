// SPDX-License-Identifier: Apache-2.0
// Finds diffuse light of surfaces in an illumination map: of a first surface, and of those on which
// walks end.
#pragma once
#include "light/sample/illumination_map.h"
#include "light/material/bsdf_types.h"
#include "light/sample.h"
#include "light/sample/transport.h"

namespace wellspring::light {

struct KnownLight {
  bool known = false;
  vec3 light{0};     // light of a surface without a coat
  vec3 unit{1};      // Sample::known
  float raised = 0;  // Sample::raised
};
// Returns the chart of the surface that a ray has met, on the side that the ray came from; or
// no_chart.
uint32_t find_chart(const IlluminationCharts& charts, const World& world, const Ray& ray,
                    const Hit& hit);
// Returns whether a map has the light of the surface that a ray has met, in air.
bool has_known_light(const Transport& transport, const Ray& ray, const Hit& hit);
// Finds the light of the surface that a ray has met at `position` in air, as it falls on the mesh.
KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            vec3 position);
// Does the same for light as it falls on the surface's own normal, which a map of normals may have
// turned.
KnownLight find_known_light(const Transport& transport, const Ray& ray, const Hit& hit,
                            const Surface& surface);
// Finds light on which a ray in air may end, as it falls on the surface that the ray has met
// (irradiance over pi). `sharp`: shadows of what moves would be seen. Returns false if there is no
// such light.
bool find_kept_light(const Transport& transport, const Ray& ray, const Hit& hit, bool sharp,
                     vec3& light);
// kept_reflectance() returns the share that a surface reflects of light that is as bright all
// around. A sharp gloss is left out: walks follow it.
bool has_sharp_gloss(const Bsdf& bsdf);
vec3 kept_reflectance(const Bsdf& bsdf);

// Returns whether something that moves may change the light there by more than a little: it is
// near, or close to the way from a punctual light.
bool may_be_shaded(const Transport& transport, vec3 position);

// Counts a sample's light in multiples of the known light; `light` is what the sample has found. A
// little is added to both, so that the dark has no noise.
inline void tell_in_units(const KnownLight& known, vec3 light, Sample& sample) {
  sample.known = known.unit;
  sample.raised = known.raised;
  sample.flags |= sample_mapped;
  sample.smooth = (light + vec3(known.raised)) / known.unit;
}

}  // namespace wellspring::light
