// SPDX-License-Identifier: Apache-2.0
// Uniform numbers in [0, 1) bent into directions and points, with densities; and the frames they
// live in.
#pragma once
#include <cmath>
#include <utility>

#include "base/vec.h"

namespace wellspring::light {

// Two unit vectors that complete `n` to a right-handed frame (Duff et al. 2017, JCGT 6(1)).
inline void make_frame_axes(vec3 n, vec3& tangent, vec3& bitangent) {
  float sign = std::copysign(1.0f, n.z);
  float a = -1 / (sign + n.z), b = n.x * n.y * a;
  tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// Cosine and sine of a share of a full turn, u in [0, 1]: within 1e-7.
inline vec2 unit_circle(float u) {
  float quarter = u * 4;
  int turn = int(quarter + 0.5f);
  float x = (quarter - float(turn)) * (pi / 2), x2 = x * x;
  float s = x * (1 + x2 * (-1 / 6.0f + x2 * (1 / 120.0f + x2 * (-1 / 5040.0f + x2 / 362880.0f))));
  float c = 1 + x2 * (-0.5f + x2 * (1 / 24.0f + x2 * (-1 / 720.0f + x2 / 40320.0f)));
  if (turn & 1) std::swap(s, c), c = -c;
  return turn & 2 ? vec2(-c, -s) : vec2(c, s);
}

// z up; density z / pi.
inline vec3 sample_cosine_hemisphere(vec2 u) {
  return {std::sqrt(u.x) * unit_circle(u.y), std::sqrt(std::max(0.0f, 1 - u.x))};
}

// Uniform over the sphere.
inline vec3 sample_sphere(vec2 u) {
  float z = 1 - 2 * u.x, radius = std::sqrt(std::max(0.0f, 1 - z * z));
  return {radius * unit_circle(u.y), z};
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

}  // namespace wellspring::light
