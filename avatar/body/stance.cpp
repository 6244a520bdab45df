// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/stance.h"

#include "base/vec.h"

namespace wellspring::avatar {
namespace {
constexpr float step_seconds = 0.55f, widest_step = 50_deg, least_step = 8_deg;
}

float Foot::lift() const { return phase < 1 ? 0.045f * std::sin(pi * phase) : 0; }

void tick_stance(StanceState& state, bool has_legs, float aim, float reach, float patience,
                 double now, float dt) {
  float turn = std::abs(aim - state.heading.value);
  bool away = reach < 0 ? state.wanted != 0 : turn > reach;
  if (!away) state.turned_away = -1e30;
  else if (state.turned_away < 0) state.turned_away = now;
  if (away && now - state.turned_away >= patience) {
    state.wanted = reach < 0 ? 0 : aim;
    state.turned_away = -1e30;
  }
  if (!has_legs) {
    settle(state.heading, state.wanted, 3, dt);
    return;
  }
  for (Foot& foot : state.foot)
    if (foot.phase < 1) {
      foot.phase = std::min(foot.phase + dt / step_seconds, 1.0f);
      if (foot.phase >= 1) foot.from = foot.to;
    }
  Foot &left = state.foot[0], &right = state.foot[1];
  if (left.phase >= 1 && right.phase >= 1) {
    // Whole turns are taken back, so that years of turning one way lose no precision.
    float whole = 2 * pi * std::round(state.heading.value / (2 * pi));
    state.heading.value -= whole;
    state.wanted -= whole;
    for (Foot& foot : state.foot) foot.from -= whole, foot.to -= whole;
    float left_off = state.wanted - left.to, right_off = state.wanted - right.to;
    // Turning left begins with the left foot, so that the feet never cross.
    int first = std::abs(left_off) < least_step    ? 1
                : std::abs(right_off) < least_step ? 0
                : left_off > 0                     ? (left_off >= right_off ? 0 : 1)
                                                   : (right_off <= left_off ? 1 : 0);
    float off = first == 0 ? left_off : right_off;
    if (std::abs(off) >= least_step) {
      Foot& foot = state.foot[size_t(first)];
      foot.to = foot.from + std::clamp(off, -widest_step, widest_step);
      foot.phase = std::min(dt / step_seconds, 0.999f);
    }
  }
  settle(state.heading, 0.5f * (left.facing() + right.facing()), 7, dt);
  float stand = left.phase < 1 ? -1.0f : right.phase < 1 ? 1.0f : 0.0f;
  settle(state.lean, 0.035f * stand, 9, dt);
}

}  // namespace wellspring::avatar
