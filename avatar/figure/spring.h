// SPDX-License-Identifier: Apache-2.0
// Motion towards a target that does not depend on the tick rate: closed forms, safe for any dt.
#pragma once
#include <algorithm>
#include <cmath>

namespace wellspring::avatar {

struct Spring {
  float value = 0, velocity = 0;
};

// Critically damped: 90 % of a step after 3.9 / rate seconds, never beyond it from rest.
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

// First-order lag: 63 % of a step after `tau` seconds.
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

}  // namespace wellspring::avatar
