// SPDX-License-Identifier: Apache-2.0
#include "light/material/light_slope.h"

#include <array>

namespace wellspring::light {
namespace {

constexpr int steps = 64;                         // steps of the cosine, from 0 to 1
constexpr float spread = 0.4f, farthest = 1.05f;  // radians: tilts of mapped normals
constexpr float least_cosine = 0.05f;             // nearer to the horizon light is no less certain

// Holds the best fit of the clamped cosine max(0, dot(seen, direction)) over normals `seen` around
// the mesh's, exact at the mesh's: cosine + along * (dot(seen, normal) - 1) + across * dot(seen,
// t), where t is the part of the direction across the normal, unit.
struct Fit {
  float along = 0, across = 0;
};

Fit fit_cosine(float cosine) {
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  double along[2] = {0, 0}, across[2] = {0, 0};
  constexpr int tilts = 48, turns = 64;
  for (int i = 0; i < tilts; i++) {
    const float tilt = farthest * (float(i) + 0.5f) / tilts;
    const float weight = std::sin(tilt) * std::exp(-0.5f * (tilt / spread) * (tilt / spread));
    const float up = std::cos(tilt) - 1;
    for (int k = 0; k < turns; k++) {
      const float side = std::sin(tilt) * std::cos(2 * pi * (float(k) + 0.5f) / turns);
      const float off = std::max(0.0f, (up + 1) * cosine + side * sine) - cosine;
      along[0] += double(weight * off * up), along[1] += double(weight * up * up);
      across[0] += double(weight * off * side), across[1] += double(weight * side * side);
    }
  }
  return {float(along[0] / along[1]), float(across[0] / across[1])};
}

std::array<Fit, steps + 1> make_fits() {
  std::array<Fit, steps + 1> fits;
  for (int i = 0; i <= steps; i++) fits[size_t(i)] = fit_cosine(float(i) / steps);
  return fits;
}

}  // namespace

vec3 slope_of(vec3 direction, vec3 normal) {
  static const std::array<Fit, steps + 1> fits = make_fits();
  const float cosine = std::clamp(dot(direction, normal), 0.0f, 1.0f), at = cosine * steps;
  const int i = std::min(int(at), steps - 1);
  const float part = at - float(i);
  const float along = glm::mix(fits[size_t(i)].along, fits[size_t(i) + 1].along, part),
              across = glm::mix(fits[size_t(i)].across, fits[size_t(i) + 1].across, part);
  const vec3 side = direction - normal * dot(direction, normal);
  const float length2 = dot(side, side);
  vec3 slope = along * normal;
  if (length2 > 1e-12f) slope += across / std::sqrt(length2) * side;
  return slope / std::max(cosine, least_cosine);
}

}  // namespace wellspring::light
