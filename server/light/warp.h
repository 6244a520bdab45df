// SPDX-License-Identifier: Apache-2.0
// Uniform numbers in [0, 1) bent into directions and points, with densities; and the frames they
// live in.
#pragma once
#include <cmath>

#include "base/vec.h"

namespace wellspring {

// Two unit vectors that complete `n` to a right-handed frame (Duff et al. 2017, JCGT 6(1)).
inline void make_frame_axes(vec3 n, vec3& tangent, vec3& bitangent) {
  float sign = std::copysign(1.0f, n.z);
  float a = -1 / (sign + n.z), b = n.x * n.y * a;
  tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// z up; density z / pi.
inline vec3 sample_cosine_hemisphere(vec2 u) {
  float radius = std::sqrt(u.x), phi = 2 * pi * u.y;
  return {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.0f, 1 - u.x))};
}

// Uniform over the sphere.
inline vec3 sample_sphere(vec2 u) {
  float z = 1 - 2 * u.x, radius = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi * u.y;
  return {radius * std::cos(phi), radius * std::sin(phi), z};
}

// Barycentric weights of the second and third corner, uniform over the triangle.
inline vec2 sample_triangle(vec2 u) {
  float root = std::sqrt(u.x);
  return {root * (1 - u.y), root * u.y};
}

// Weight of a sample drawn with density `own` where another strategy could have drawn it with
// density `other`: the power heuristic with exponent 2 (Veach 1997, section 9.2.4). An infinite
// density wins.
inline float mis_weight(float own, float other) {
  if (other <= 0) return 1;
  float ratio = other / own;
  return 1 / (1 + ratio * ratio);
}

}  // namespace wellspring
