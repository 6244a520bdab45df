// SPDX-License-Identifier: Apache-2.0
// Wind: a weighted sum of trigonometric functions of a root's place and of the time (Orthmann,
// Rezk-Salama, Kolb, section 5). It has no state, so that a page that knows these few numbers moves
// its grass alike. At a root (x, z) and a time t, tips are pushed by
//   strength * (lean + sum over waves of push * sin(dot(wave, (x, z)) - rate * t + phase))
// times the blade's `give`; 1 is as much as the blade's own uprightness.
#pragma once
#include <array>

#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::lawn {

struct WindWave {
  vec2 push{0};     // x and z: which way it pushes, and how much
  vec2 wave{0};     // radians a metre
  double rate = 0;  // radians a second
  double phase = 0;
};

// By default a breeze to +x: a long gust, two shorter ones aslant, and a flutter.
struct Wind {
  float strength = 1;  // 0: grass stands still
  vec2 lean{0.18f, 0.04f};
  std::array<WindWave, 4> waves = {{{{0.16f, 0.03f}, {0.9f, 0.25f}, 1.3, 0},
                                    {{0.09f, 0.05f}, {1.7f, -0.8f}, 2.1, 1.7},
                                    {{0.04f, -0.06f}, {-1.1f, 2.9f}, 3.4, 4.1},
                                    {{0.03f, 0.03f}, {7.3f, 5.1f}, 7.9, 2.6}}};
};

// A wind at one moment. Phases are reduced in doubles, so it is right after hours, too.
class WindNow {
 public:
  WindNow(const Wind& wind, double time);
  // Computes the push at eight roots; exactly 0 without wind.
  void push_at(const Lanes& x, const Lanes& z, Lanes& push_x, Lanes& push_z) const;

 private:
  struct Wave {
    float push_x, push_z, wave_x, wave_z, phase;
  };
  std::array<Wave, 4> waves_;
  vec2 lean_{0};
};

}  // namespace wellspring::lawn
