// SPDX-License-Identifier: Apache-2.0
// Swings hair, cloth and what else hangs on a figure when it moves: the spring bones of VRM
// (VRMC_springBone-1.0), whose rule moves a bone's end once every sixtieth of a second by its
// inertia less drag, by its stiffness and by gravity. Here each bone is the damped oscillator that
// this rule means, in closed form: about the direction in which stiffness and gravity together want
// it, so that any time step is stable and a bone left alone swings alike at any tick rate.
//   theta'' = -(60 F / L) theta - c theta',  F = |stiffness * way + gravity|,
//   c = -60 log(1 - drag)
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// Moves values towards a target independently of the tick rate: closed forms, safe for any dt.

struct Spring {
  float value = 0, velocity = 0;
};

// Settles by critical damping: 90 % of a step after 3.9 / rate seconds, never beyond it from rest.
// x(t) = target + (d + (v + rate d) t) exp(-rate t).
inline void settle(Spring& spring, float target, float rate, float dt) {
  float x = rate * dt;
  if (!(x < 60)) {
    spring = {target, 0};
    return;
  }
  float d = spring.value - target, t = (spring.velocity + rate * d) * dt, e = std::exp(-x);
  spring.value = target + (d + t) * e;
  spring.velocity = (spring.velocity - rate * t) * e;
}

// Follows with a first-order lag: 63 % of a step after `tau` seconds.
inline float approach(float value, float target, float tau, float dt) {
  return target + (value - target) * std::exp(-dt / tau);
}

inline float smooth_step(float low, float high, float x) {
  float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

inline constexpr float degrees_to_radians = 0.017453292519943295f;
constexpr float operator""_deg(long double v) { return float(v) * degrees_to_radians; }
constexpr float operator""_deg(unsigned long long v) { return float(v) * degrees_to_radians; }

// Holds the place of a bone's end and how fast the bone turns; one a bone of Character::springs.
struct SpringBoneState {
  vec3 end{0}, turning{0};  // metres and radians a second, in the frame of its `center`
};

struct SpringBonesState {
  std::vector<SpringBoneState> bones;  // empty: the bones begin hanging at rest
  struct Frame {
    vec3 center{0};
    quat rotation{1, 0, 0, 0};
    bool changed = false;
  };
  std::vector<Frame> frames;  // working memory: each joint as posed
};

// Turns the joints of character.springs in `pose`, which has the rest of the figure as it is after
// `dt` seconds. Called once a tick; a figure without springs costs nothing. Never fails: bones that
// are not finite hang as modelled.
void tick_spring_bones(SpringBonesState& state, const Character& character, float dt, Pose& pose);

}  // namespace wellspring::avatar
