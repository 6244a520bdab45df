// SPDX-License-Identifier: Apache-2.0
// How the storyteller bends to a guest whose eyes are lower than its own, a child or somebody in a
// wheelchair: knees and chest together, softly, and only to who stands near.
#pragma once
#include <optional>

#include "avatar/figure/spring.h"
#include "base/vec.h"

namespace wellspring::avatar {

struct BowState {
  Spring share;  // 0: upright, 1: as far as it bends
};

// Metres: eyes that are so much lower are met by looking down alone, and from the second on by all.
inline constexpr float bow_from = 0.15f, bow_all = 0.4f;
// Metres to the guest's eyes, within which it bends wholly, and beyond which not at all: to bend to
// somebody far off is a bow.
inline constexpr float bow_near = 2, bow_far = 3.5f;
// Of a whole one: metres that the pelvis sinks, radians that the chest leans.
inline constexpr float bow_sink = 0.1f, bow_lean = 14.0_deg;

// `guest`: the eyes of who is looked at, `eyes`: its own when it stands upright, in one space;
// null: nobody.
void tick_bow(BowState& state, std::optional<vec3> guest, vec3 eyes, float dt);

}  // namespace wellspring::avatar
