// SPDX-License-Identifier: Apache-2.0
#include "world/fit_view.h"

namespace wellspring::world {

float distance_to_fit(vec3 half, vec3 back, float tan_x, float tan_y) {
  vec3 aside = cross(vec3(0, 1, 0), back);
  vec3 right = glm::length(aside) > 1e-6f ? normalize(aside) : vec3(1, 0, 0);
  vec3 up = cross(back, right);
  float distance = 1e-3f;
  for (int corner = 0; corner < 8; corner++) {
    vec3 p = half * vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    float towards = dot(p, back);
    distance = std::max(distance, std::abs(dot(p, right)) / tan_x + towards);
    distance = std::max(distance, std::abs(dot(p, up)) / tan_y + towards);
  }
  return distance;
}

}  // namespace wellspring::world
