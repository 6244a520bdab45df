// SPDX-License-Identifier: Apache-2.0
// Gives GLM's vectors, matrices and quaternions short names. Column vectors, right-handed, +Y up,
// cameras look down -Z. Metres and radians unless a name says otherwise.
#pragma once
#ifndef GLM_FORCE_XYZW_ONLY
#define GLM_FORCE_XYZW_ONLY  // only .x .y .z .w: smaller types, clearer debugger views
#endif
#ifndef GLM_ENABLE_EXPERIMENTAL
#define GLM_ENABLE_EXPERIMENTAL
#endif
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/layers.h"

namespace wellspring {
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;
using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::quat;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float pi = 3.14159265358979323846f;

inline float max_component(vec3 v) { return glm::max(v.x, glm::max(v.y, v.z)); }
// Returns the Rec. 709 relative luminance of a linear colour.
inline float luminance(vec3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline bool is_finite(vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
}  // namespace wellspring
