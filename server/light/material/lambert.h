// SPDX-License-Identifier: Apache-2.0
// Lambert's law alone, for surfaces that is_lambertian: what make_bsdf, eval_bsdf and sample_bsdf
// come to there, without the lobes that are not.
#pragma once
#include "light/material/bsdf_frame.h"

namespace wellspring::light {

struct LambertLobe {
  vec3 normal, geometric_normal;  // the viewer's side; the shading normal as bsdf_frame.h turns it
  vec3 reflectance;
};
inline LambertLobe make_lambert(const LambertSurface& surface, vec3 direction) {
  return {usable_normal(surface.normal, surface.geometric_normal, -direction),
          surface.geometric_normal, clean(surface.base_color)};
}

// Density of sampling and, times the reflectance, value times cosine.
inline float eval_lambert_pdf(const LambertLobe& lobe, vec3 direction) {
  float cosine = dot(direction, lobe.normal);
  bool above = dot(direction, lobe.geometric_normal) > 0 && cosine > 1e-6f;
  return above ? std::min(cosine, 1.0f) / pi : 0;
}

// Weight: the reflectance.
inline BsdfSample sample_lambert(const LambertLobe& lobe, vec2 u) {
  BsdfSample s;
  vec3 tangent, bitangent;
  make_frame_axes(lobe.normal, tangent, bitangent);
  vec3 l = sample_cosine_hemisphere(u);
  s.direction = tangent * l.x + bitangent * l.y + lobe.normal * l.z;
  s.pdf = eval_lambert_pdf(lobe, s.direction);
  if (s.pdf > 0) s.weight = lobe.reflectance;
  return s;
}

}  // namespace wellspring::light
