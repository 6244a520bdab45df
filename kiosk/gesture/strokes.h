// SPDX-License-Identifier: Apache-2.0
// Hand movements as people make them: a sum of strokes that overlap in time, each along an arc with
// a lognormal speed (Plamondon 1995; the sigma-lognormal model of O'Reilly and Plamondon 2009).
// Overlap rounds corners and makes the hand slow where it turns. Units as in trajectory.h.
#pragma once
#include <span>
#include <vector>

#include "base/rng.h"
#include "kiosk/gesture/trajectory.h"

namespace wellspring::kiosk {

struct Stroke {
  vec2 chord{0};       // from its first to its last place
  float bend = 0;      // radians that the direction turns in between, clockwise on the screen
  double begin = 0;    // seconds
  double seconds = 0;  // for 99.7 % of its way
  float sigma = 0.3f;  // of the lognormal: how lopsided the speed is
};

// Where the strokes have taken a hand that started at 0.
vec2 eval_strokes(std::span<const Stroke> strokes, double time);

// A camera that watches: frames a second, share of frames without a hand, noise of a place.
struct HandCamera {
  float rate = 20, lost = 0.02f;
  float noise = 0.008f;   // standard deviation of each place, shoulder widths
  float tremor = 0.006f;  // of a slow part that takes about a fifth of a second to change
};
std::vector<HandPlace> watch_strokes(std::span<const Stroke> strokes, vec2 start, double seconds,
                                     const HandCamera& camera, Rng& rng);

float normal(Rng& rng);                          // mean 0, standard deviation 1
float between(Rng& rng, float low, float high);  // uniform
vec2 turned(vec2 v, float angle);                // clockwise on the screen

}  // namespace wellspring::kiosk
