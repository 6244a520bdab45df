// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/idle.h"

#include "avatar/figure/noise.h"

namespace wellspring::avatar {

IdleMotion tick_idle(IdleState& state, Rng& rng, float lively, bool hands_busy, bool humanlike,
                     double now, float dt) {
  IdleMotion motion;
  double pace = 0.23 + 0.07 * double(lively);  // breaths a second
  if (humanlike) pace *= 1 + 0.12 * double(smooth_noise(1, now * 0.1));
  state.breath = std::fmod(state.breath + pace * double(dt), 1.0);
  // In a little faster than out, with a rest at the end.
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
