// SPDX-License-Identifier: Apache-2.0
// Computes GGX microfacets in a frame with z along the normal: distribution, shadowing, sampling of
// visible normals; and Fresnel's equations. `alpha` is the roughness along x and y, each > 0:
// perceptual roughness squared if both are the same.
#pragma once
#include <cmath>

#include "base/vec.h"

namespace wellspring::light {

// Returns the distribution (Heitz 2014, equation 85), written without the tangent so that it is
// safe near the pole.
inline float ggx_distribution(vec3 h, vec2 alpha) {
  float x = h.x / alpha.x, y = h.y / alpha.y, d = x * x + y * y + h.z * h.z;
  return 1 / (pi * alpha.x * alpha.y * d * d);
}

// Returns Smith's auxiliary function (Heitz 2014, equations 72 and 86).
inline float ggx_lambda(vec3 w, vec2 alpha) {
  float x = w.x * alpha.x, y = w.y * alpha.y;
  return 0.5f * (std::sqrt(1 + (x * x + y * y) / (w.z * w.z)) - 1);
}
inline float ggx_masking(vec3 w, vec2 alpha) { return 1 / (1 + ggx_lambda(w, alpha)); }
// Returns height-correlated masking and shadowing for reflection (Heitz 2014, equation 99).
inline float ggx_shadowing(vec3 v, vec3 l, vec2 alpha) {
  return 1 / (1 + ggx_lambda(v, alpha) + ggx_lambda(l, alpha));
}

// Draws a normal visible from v (v.z > 0), by spherical caps (Dupuy and Benyoub 2023, listing 3).
inline vec3 sample_visible_normal(vec3 v, vec2 alpha, vec2 u) {
  vec3 stretched = normalize(vec3(v.x * alpha.x, v.y * alpha.y, v.z));
  float phi = 2 * pi * u.x;
  float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  float radius = std::sqrt(glm::clamp(1 - z * z, 0.0f, 1.0f));
  vec3 h = vec3(radius * std::cos(phi), radius * std::sin(phi), z) + stretched;
  return normalize(vec3(h.x * alpha.x, h.y * alpha.y, std::max(h.z, 1e-7f)));
}

// Returns the reflectance of a smooth boundary; eta = index beyond over index here, cosine >= 0 on
// this side.
inline float fresnel_dielectric(float cosine, float eta) {
  float sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return 1;
  float beyond = std::sqrt(1 - sin2);
  float parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  float perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// Finds the direction beyond a boundary with facet normal h, v on this side; false: total
// reflection.
inline bool refract_at(vec3 v, vec3 h, float eta, vec3& out) {
  float cosine = dot(v, h), sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return false;
  out = -v / eta + (cosine / eta - std::sqrt(1 - sin2)) * h;
  return true;
}

// Return Fresnel's factor by Schlick 1994, with glTF's f90 = 1; and its mean over the hemisphere,
// weighted by the cosine.
inline vec3 fresnel_schlick(vec3 f0, float cosine) {
  float m = 1 - glm::clamp(cosine, 0.0f, 1.0f), m2 = m * m;
  return f0 + (vec3(1) - f0) * (m2 * m2 * m);
}
inline vec3 fresnel_schlick_average(vec3 f0) { return f0 + (vec3(1) - f0) / 21.0f; }

}  // namespace wellspring::light
