// SPDX-License-Identifier: Apache-2.0
// The head of the synthetic visitor: an adult's, made of distances (Hart 1996, sphere tracing) that
// are joined smoothly, with painted eyes, brows, lips and hair. Its measures are those of Farkas
// (Anthropometry of the Head and Face, 1994), so networks trained on people know it.
// Axes: x to the visitor's right, y up, z out of the face; origin between the pupils; metres.
#pragma once
#include <optional>

#include "base/vec.h"

namespace wellspring::kiosk {

struct HeadHit {
  float t = 0;     // along the ray
  vec3 normal{0};  // outwards, of length 1
  float albedo = 0;
};

// Where a ray (direction of any length) meets the head first.
std::optional<HeadHit> hit_head(vec3 origin, vec3 direction);

}  // namespace wellspring::kiosk
