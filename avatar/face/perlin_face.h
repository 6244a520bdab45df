// SPDX-License-Identifier: Apache-2.0
// Perlin's responsive face: twelve flexes with a left and a right value, which settle towards
// targets and are stirred by noise. Source: Perlin's face applet (1997, 2000), its controls, settle
// rule (95 % of the way in the settle time), noise amplitudes and frequencies. The applet adds its
// noise once a frame; here the same is an integral over time, so the tick rate does not matter:
//   dv/dt = rate (target - v) + 30 amplitude noise(3.6 frequency t),  rate = ln 20 / settle
// (30 frames a second, in which the applet's time advances by 3.6). Say_ah counts from shut lips
// (the applet's -1); blinks have a rhythm of their own (blink.h), since the applet's is too quick
// for people.
#pragma once
#include <array>
#include <cstdint>

#include "avatar/face/emotion.h"

namespace wellspring::avatar {

enum class Flex : uint8_t {
  turn,
  nod,
  tilt,
  say_ah,
  blink,
  brows,
  look_x,
  look_y,
  lids,
  say_oo,
  smile,
  sneer
};
inline constexpr size_t flex_count = 12;
extern const std::array<const char*, flex_count>
    flex_names;  // as in the applet: "sayAh", "lookX", ...

struct PerlinFace {
  struct Value {
    float settled = 0, noise = 0, target = 0;
    float sum() const { return settled + noise; }
  };
  std::array<std::array<Value, 2>, flex_count> flex;  // [flex][left, right]
  Value& at(Flex which, size_t side) { return flex[size_t(which)][side]; }
};

inline constexpr float perlin_settle_seconds = 1;

// Both sides of a flex.
void set_target(PerlinFace& face, Flex flex, float target);
// Adds what the flexes make of an emotion at `weight` to the targets.
void add_targets(PerlinFace& face, Emotion emotion, float weight);
// Ends at time `now` after `dt` seconds. Noise moves only the flexes that have any (brows, lids),
// times `stir`; 0 lets it die away. Returns the number of noise values that were drawn.
int tick_perlin(PerlinFace& face, float stir, float settle_seconds, double now, float dt);

}  // namespace wellspring::avatar
