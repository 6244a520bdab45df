// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/bow.h"

#include <cmath>

namespace wellspring::avatar {

static constexpr float bow_rate = 2.5f;  // 90 % after 1.6 s

void tick_bow(BowState& state, std::optional<vec3> guest, vec3 eyes, float dt) {
  float wanted = 0;
  if (guest && is_finite(*guest)) {
    float lower = eyes.y - guest->y, away = glm::length(*guest - eyes);
    wanted = smooth_step(bow_from, bow_all, lower) * (1 - smooth_step(bow_near, bow_far, away));
  }
  settle(state.share, wanted, bow_rate, dt);
}

}  // namespace wellspring::avatar
