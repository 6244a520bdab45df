// SPDX-License-Identifier: Apache-2.0
#include "world/material.h"

namespace wellspring::world {

Material repainted(const Material& m, const Repaint& change) {
  constexpr float most = 1e9f;  // as of a file's
  Material made = m;
  bool colors = is_finite(vec3(change.base_color)) && std::isfinite(change.base_color.w);
  if (colors) made.base_color = glm::clamp(m.base_color + change.base_color, vec4(0), vec4(1));
  if (is_finite(change.emission))
    made.emission = glm::clamp(m.emission + change.emission, vec3(0), vec3(most));
  const mat3& uv = change.uv;
  if (is_finite(uv[0]) && is_finite(uv[1]) && is_finite(uv[2]))
    each_texture(made, [&](TextureRef& use) { use.uv_transform += uv; });
  return made;
}

Material dimmed(const Material& m, float brightness) {
  Material made = m;
  made.emission *= brightness;
  // Its colour is its light.
  if (m.unlit) made.base_color = vec4(vec3(m.base_color) * brightness, m.base_color.w);
  return made;
}

}  // namespace wellspring::world
