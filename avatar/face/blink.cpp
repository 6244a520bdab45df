// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/blink.h"

#include "avatar/figure/spring.h"

namespace wellspring::avatar {
namespace {
constexpr float down = 0.07f, held = 0.035f, up = 0.12f;
}

float tick_blink(BlinkState& state, Rng& rng, double now, bool humanlike) {
  if (now >= state.next) {
    // After a long pause between ticks there is nothing to make up for.
    state.begun = now - state.next < 0.5 ? state.next : now;
    state.count++;
    if (!humanlike) {
      state.next = state.begun + 4;
      state.twice = false;
    } else if (!state.twice && rng.uniform() < 0.12f) {
      state.next = state.begun + 0.30;
      state.twice = true;
    } else {
      state.next = state.begun + 2 + 3 * double(rng.uniform());
      state.twice = false;
    }
  }
  float t = float(std::min(now - state.begun, 1e3));
  if (t < down) return smooth_step(0, down, t);
  if (t < down + held) return 1;
  return 1 - smooth_step(down + held, down + held + up, t);
}

void ask_blink(BlinkState& state, double now) {
  if (now - state.begun > 0.8 && state.next - now > 0.25) state.next = now;
}

}  // namespace wellspring::avatar
