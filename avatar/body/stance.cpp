// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/stance.h"

#include "avatar/figure/noise.h"
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

IdleMotion tick_idle(IdleState& state, Rng& rng, float lively, bool hands_busy, bool humanlike,
                     double now, float dt) {
  IdleMotion motion;
  double pace = 0.23 + 0.07 * double(lively);  // breaths a second
  if (humanlike) pace *= 1 + 0.12 * double(smooth_noise(1, now * 0.1));
  state.breath = std::fmod(state.breath + pace * double(dt), 1.0);
  // Breathing in is a little faster than out, and a rest follows.
  float b = float(state.breath);
  motion.breath = b < 0.4f ? smooth_step(0, 0.4f, b) : 1 - smooth_step(0.4f, 0.92f, b);
  motion.torso_turn.y = 0.7_deg * motion.breath;
  motion.head_turn.y = -0.4_deg * motion.breath;

  if (humanlike && now >= state.next_shift) {
    float turn = 0.5f + 0.5f * rng.uniform();
    state.side_wanted = state.side_wanted > 0 ? -turn : turn;
    state.fold_wanted = rng.uniform() < 0.6f ? 1.0f : 0.0f;
    state.next_shift = now + 9 + 14 * double(rng.uniform());
  }
  if (!humanlike) state.side_wanted = state.fold_wanted = 0;
  settle(state.side, state.side_wanted, 1.6f, dt);
  settle(state.fold, hands_busy ? 0 : state.fold_wanted, hands_busy ? 5.0f : 2.2f, dt);
  float side = state.side.value;
  motion.pelvis = {0.020f * side, -0.003f * std::abs(side), 0};
  motion.pelvis_turn = {1.5_deg * side, 0, 1.2_deg * side};
  motion.torso_turn.z = -2.0_deg * side;
  motion.torso_turn.x = -1.0_deg * side;
  motion.head_turn.z = 0.8_deg * side;
  if (!humanlike) return motion;

  auto noise = [&](uint32_t channel, double frequency) {
    return smooth_noise(channel, now * frequency);
  };
  motion.pelvis += vec3(0.004f * noise(10, 0.31), 0, 0.005f * noise(11, 0.27));
  motion.torso_turn +=
      vec3(0.8_deg * noise(12, 0.23), 0.5_deg * noise(13, 0.29), 0.5_deg * noise(14, 0.21));
  motion.head_turn += vec3(1.2_deg * noise(15, 0.35) + 0.5_deg * noise(16, 0.9),
                           0.9_deg * noise(17, 0.4), 1.6_deg * noise(18, 0.25));
  for (uint32_t s = 0; s < 2; s++) {
    motion.arm[s] = {1.2_deg * noise(20 + 4 * s, 0.3), 0.5_deg * noise(21 + 4 * s, 0.24),
                     2.0_deg * noise(22 + 4 * s, 0.36)};
    motion.curl[s] = 5_deg * noise(23 + 4 * s, 0.33);
  }
  return motion;
}

}  // namespace wellspring::avatar
