// SPDX-License-Identifier: Apache-2.0
// GGX microfacets, isotropic, in a frame with z along the normal: distribution, shadowing, sampling
// of visible normals; and Fresnel's equations. alpha = perceptual roughness squared, > 0.
#pragma once
#include <cmath>

#include "base/vec.h"

namespace wellspring {

// Walter et al. 2007, equation 33, written without the tangent so that it is safe near the pole.
inline float ggx_distribution(vec3 h, float alpha) {
  float a2 = alpha * alpha;
  float d = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
  return 1 / (pi * a2 * d * d);
}

// Smith's auxiliary function (Heitz 2014, equation 72).
inline float ggx_lambda(vec3 w, float alpha) {
  float tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
  return 0.5f * (std::sqrt(1 + alpha * alpha * tan2) - 1);
}
inline float ggx_masking(vec3 w, float alpha) { return 1 / (1 + ggx_lambda(w, alpha)); }
// Height-correlated masking and shadowing for reflection (Heitz 2014, equation 99).
inline float ggx_shadowing(vec3 v, vec3 l, float alpha) {
  return 1 / (1 + ggx_lambda(v, alpha) + ggx_lambda(l, alpha));
}

// A normal visible from v (v.z > 0), by spherical caps (Dupuy and Benyoub 2023, listing 3).
inline vec3 sample_visible_normal(vec3 v, float alpha, vec2 u) {
  vec3 stretched = normalize(vec3(v.x * alpha, v.y * alpha, v.z));
  float phi = 2 * pi * u.x;
  float z = (1 - u.y) * (1 + stretched.z) - stretched.z;
  float radius = std::sqrt(glm::clamp(1 - z * z, 0.0f, 1.0f));
  vec3 h = vec3(radius * std::cos(phi), radius * std::sin(phi), z) + stretched;
  return normalize(vec3(h.x * alpha, h.y * alpha, std::max(h.z, 1e-7f)));
}
inline float sample_visible_normal_pdf(vec3 v, vec3 h, float alpha) {
  return ggx_masking(v, alpha) * std::max(0.0f, dot(v, h)) * ggx_distribution(h, alpha) / v.z;
}

// Reflectance of a smooth boundary; eta = index beyond over index here, cosine >= 0 on this side.
inline float fresnel_dielectric(float cosine, float eta) {
  float sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return 1;
  float beyond = std::sqrt(1 - sin2);
  float parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  float perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

// The direction beyond a boundary with facet normal h, v on this side; false: total reflection.
inline bool refract_at(vec3 v, vec3 h, float eta, vec3& out) {
  float cosine = dot(v, h), sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return false;
  out = -v / eta + (cosine / eta - std::sqrt(1 - sin2)) * h;
  return true;
}

// Schlick 1994, with glTF's f90 = 1.
inline vec3 fresnel_schlick(vec3 f0, float cosine) {
  float m = 1 - glm::clamp(cosine, 0.0f, 1.0f), m2 = m * m;
  return f0 + (vec3(1) - f0) * (m2 * m2 * m);
}

}  // namespace wellspring
