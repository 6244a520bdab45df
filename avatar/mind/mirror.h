// SPDX-License-Identifier: Apache-2.0
// The lazy mirror: the guest's head rotation, halved, late and soft, to be added to the
// storyteller's own. Source: storyteller and kiosk paper, "a delayed and lazy mirror"; its numbers
// are ours.
#pragma once
#include <array>

#include "base/vec.h"

namespace wellspring::avatar {

inline constexpr float mirror_share = 0.5f, mirror_delay = 0.35f, mirror_lag = 0.6f;

struct MirrorState {
  struct Heard {
    double time = -1e30;
    vec2 wanted{0};
  };
  std::array<Heard, 64> heard;  // ring of changes still on their way, oldest first from `first`
  int first = 0, count = 0;
  vec2 arrived{0};  // what the lag follows
  vec2 angle{0};    // yaw to its own left (the guest's right), pitch up; radians
};

// `rotation` as Guest::rotation; `present` false: the wanted angle is 0. `now` is the clock after
// `dt`.
void tick_mirror(MirrorState& state, bool present, vec3 rotation, double now, float dt);

}  // namespace wellspring::avatar
