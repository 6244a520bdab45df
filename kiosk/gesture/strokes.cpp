// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/strokes.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

// The displacement after a share of the arc.
vec2 along_arc(const Stroke& stroke, float share) {
  if (std::abs(stroke.bend) < 1e-3f) return stroke.chord * share;
  const float radius = glm::length(stroke.chord) / (2 * std::sin(stroke.bend / 2));
  const float first = std::atan2(stroke.chord.y, stroke.chord.x) - stroke.bend / 2;
  const float now = first + stroke.bend * share;
  return radius * vec2(std::sin(now) - std::sin(first), std::cos(first) - std::cos(now));
}

}  // namespace

float normal(Rng& rng) {
  const float radius = std::sqrt(-2 * std::log(1 - rng.uniform()));
  return radius * std::cos(2 * pi * rng.uniform());
}

float between(Rng& rng, float low, float high) { return low + (high - low) * rng.uniform(); }

vec2 turned(vec2 v, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

vec2 eval_strokes(std::span<const Stroke> strokes, double time) {
  vec2 place{0};
  for (const Stroke& stroke : strokes) {
    // `seconds` reaches from three deviations before the median to three after it.
    const double median = stroke.seconds / (2 * std::sinh(3.0 * stroke.sigma));
    const double passed = time - stroke.begin + median * std::exp(-3.0 * stroke.sigma);
    if (passed <= 0) continue;
    const double z = std::log(passed / median) / stroke.sigma;
    place += along_arc(stroke, float(0.5 * std::erfc(-z / std::sqrt(2.0))));
  }
  return place;
}

std::vector<HandPlace> watch_strokes(std::span<const Stroke> strokes, vec2 start, double seconds,
                                     const HandCamera& camera, Rng& rng) {
  std::vector<HandPlace> places;
  const double step = 1 / double(camera.rate);
  const float keep = std::exp(-float(step) / 0.2f);
  vec2 slow = camera.tremor * vec2(normal(rng), normal(rng));
  for (double time = 0; time < seconds; time += step) {
    const vec2 fresh(normal(rng), normal(rng)), noise(normal(rng), normal(rng));
    slow = keep * slow + std::sqrt(1 - keep * keep) * camera.tremor * fresh;
    if (rng.uniform() < camera.lost) continue;
    places.push_back({time, start + eval_strokes(strokes, time) + slow + camera.noise * noise});
  }
  return places;
}

}  // namespace wellspring::kiosk
