// SPDX-License-Identifier: Apache-2.0
#include "avatar/mind/storyteller_io.h"

#include <cmath>

#include "avatar/figure/spring_bones.h"

namespace wellspring::avatar {

static constexpr float bow_rate = 2.5f;  // 1/s; 90 % are reached after 1.6 s

void tick_bow(BowState& state, std::optional<vec3> guest, vec3 eyes, float dt) {
  float wanted = 0;
  if (guest && is_finite(*guest)) {
    float lower = eyes.y - guest->y, away = glm::length(*guest - eyes);
    wanted = smooth_step(bow_from, bow_all, lower) * (1 - smooth_step(bow_near, bow_far, away));
  }
  settle(state.share, wanted, bow_rate, dt);
}

namespace {

// Returns nothing below the dead zone, without a jump at its edge: full size again at twice the
// zone.
float wanted(float angle, float limit) {
  constexpr float dead = 4_deg;
  float size = std::abs(angle);
  float kept = size * smooth_step(dead, 2 * dead, size);
  return std::copysign(std::min(mirror_share * kept, limit), angle);
}

}  // namespace

void tick_mirror(MirrorState& state, bool present, vec3 rotation, double now, float dt) {
  vec2 target(0);
  if (present && is_finite(rotation))
    target = {wanted(rotation.x, 25_deg), wanted(rotation.y, 12_deg)};
  int size = int(state.heard.size());
  vec2 newest = state.count ? state.heard[size_t((state.first + state.count - 1) % size)].wanted
                            : state.arrived;
  if (target != newest) {
    // A full ring (very fast ticks) replaces its newest entry: the latest value counts.
    if (state.count < size) state.count++;
    state.heard[size_t((state.first + state.count - 1) % size)] = {now, target};
  }
  // The lag is integrated exactly between the moments at which delayed values arrive.
  double time = now - dt;
  auto advance = [&](double until) {
    float step = float(std::max(until - time, 0.0));
    for (int i = 0; i < 2; i++)
      state.angle[i] = approach(state.angle[i], state.arrived[i], mirror_lag, step);
    time = std::max(time, until);
  };
  while (state.count) {
    const MirrorState::Heard& next = state.heard[size_t(state.first)];
    double due = next.time + mirror_delay;
    if (due > now) break;
    advance(due);
    state.arrived = next.wanted;
    state.first = (state.first + 1) % size;
    state.count--;
  }
  advance(now);
}

}  // namespace wellspring::avatar
