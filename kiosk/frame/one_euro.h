// SPDX-License-Identifier: Apache-2.0
// The one-euro filter (Casiez, Roussel, Vogel, CHI 2012, section 3): a low pass whose cut-off rises
// with the speed of the signal, so a resting head rests and a quick one is not late. First lower
// `min_cutoff` until rest is still, then raise `beta` until motion does not lag.
#pragma once
#include <cmath>

#include "base/vec.h"

namespace wellspring::kiosk {

struct OneEuroSettings {
  float min_cutoff = 1;    // Hz
  float beta = 0;          // Hz per (unit a second)
  float speed_cutoff = 1;  // Hz, of the speed's own filter
};

struct OneEuro {
  bool started = false;
  double time = 0;
  vec3 value{0}, speed{0};
};

inline float one_euro_alpha(float cutoff, float step) {
  float tau = 1 / (2 * pi * cutoff);
  return 1 / (1 + tau / step);
}

// Returns the filtered value of `raw` seen at `time` seconds. The first value passes as it is; a
// value that is not finite, or not later than the last one, changes nothing.
inline vec3 step_one_euro(OneEuro& filter, const OneEuroSettings& settings, double time, vec3 raw) {
  if (!is_finite(raw)) return filter.value;
  if (!filter.started) {
    filter = {true, time, raw, vec3(0)};
    return raw;
  }
  float step = float(time - filter.time);
  if (!(step > 0)) return filter.value;
  filter.time = time;
  vec3 speed = (raw - filter.value) / step;
  filter.speed += one_euro_alpha(settings.speed_cutoff, step) * (speed - filter.speed);
  float cutoff = settings.min_cutoff + settings.beta * glm::length(filter.speed);
  filter.value += one_euro_alpha(cutoff, step) * (raw - filter.value);
  return filter.value;
}

}  // namespace wellspring::kiosk
