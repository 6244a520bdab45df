// SPDX-License-Identifier: Apache-2.0
// Predicts where a followed face goes, and says how well a face that was found fits: by place and
// size alone, so that two people who cross keep their numbers and nothing of their looks is kept.
#pragma once
#include <optional>

#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

struct FacePath {
  bool started = false;
  double time = 0;  // seconds: when the face was seen last
  vec2 middle{0};   // pixels, then
  vec2 pace{0};     // pixels a second, mean over the last quarter of a second
  float width = 0;  // pixels, mean over the last half second
};

// Adds a place; a time that is not later replaces the last one.
void add_place(FacePath& path, double time, const Box& face);
// Returns where the face is to be at that time, as far as half a second on.
Box predict(const FacePath& path, double time);
// Returns how far a face is from what is predicted, 0 (not at all) to 1 (as far as a face can be);
// nothing if it must be another one: heads move up to three face widths a second and change their
// size by a fourth, and by more after a gap.
std::optional<float> misfit(const FacePath& path, double time, const Box& face);

}  // namespace wellspring::kiosk
