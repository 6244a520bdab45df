// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "attention/saliency.h"

namespace wellspring::test {

// Saliency at a place of the picture in pixels, whole numbers being the middles of pixels:
// interpolated linearly; beyond the border as at the border. 0 of an empty map.
inline float eval_saliency_at(const SaliencyMap& saliency, vec2 place) {
  const Plane& map = saliency.map;
  if (map.value.empty()) return 0;
  auto clamp = [](float x, int size) { return std::clamp(x, 0.0f, float(size - 1)); };
  vec2 at = saliency.offset + place / float(1 << saliency_scale);
  float x = clamp(at.x, map.width), y = clamp(at.y, map.height);
  int left = int(x), top = int(y);
  int right = std::min(left + 1, map.width - 1), bottom = std::min(top + 1, map.height - 1);
  const float *above = map.row(top), *below = map.row(bottom);
  vec2 share = vec2(x - float(left), y - float(top));
  return glm::mix(glm::mix(above[left], above[right], share.x),
                  glm::mix(below[left], below[right], share.x), share.y);
}

}  // namespace wellspring::test
