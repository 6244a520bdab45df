// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/perlin_face.h"

#include <algorithm>
#include <cmath>

#include "avatar/figure/noise.h"

namespace wellspring::avatar {

const std::array<const char*, flex_count> flex_names = {"turn",  "nod",   "tilt",  "sayAh",
                                                        "blink", "brows", "lookX", "lookY",
                                                        "lids",  "sayOo", "smile", "sneer"};

namespace {

// The applet's table. Turn, nod and looks are stirred by the body's and the eyes' own noise.
struct Stir {
  Flex flex;
  float amplitude, frequency;
};
constexpr Stir stirs[] = {{Flex::brows, 0.10f, 0.5f}, {Flex::lids, 0.15f, 0.5f}};
constexpr double frames_a_second = 30, applet_time = 3.6;
constexpr double longest_step = 1.0 / 50;  // of the integral; noise has about two cells a second

double noise_at(Flex flex, size_t side, float frequency, double time) {
  return double(smooth_noise(100 + 2 * uint32_t(flex) + uint32_t(side),
                             applet_time * double(frequency) * time));
}

// e^(-rate t) inside the integral, Simpson's rule outside.
double integrate(const Stir& stir, size_t side, double value, double rate, double scale,
                 double from, double to, int& drawn) {
  int steps = int(std::ceil((to - from) / longest_step));
  if (steps <= 0) return value;
  double h = (to - from) / steps, whole = std::exp(-rate * h), half = std::exp(-rate * h / 2);
  double a = noise_at(stir.flex, side, stir.frequency, from);
  for (int i = 0; i < steps; i++) {
    double t = from + i * h;
    double b = noise_at(stir.flex, side, stir.frequency, t + h / 2);
    double c = noise_at(stir.flex, side, stir.frequency, t + h);
    value = value * whole + scale * h / 6 * (a * whole + 4 * b * half + c);
    a = c;
  }
  drawn += 2 * steps + 1;
  return value;
}

struct Share {
  Emotion emotion;
  Flex flex;
  float value;
};
constexpr Share shares[] = {
    {Emotion::joy, Flex::smile, 1.1f},       {Emotion::joy, Flex::brows, 0.1f},
    {Emotion::joy, Flex::say_ah, 0.25f},     {Emotion::sadness, Flex::brows, 0.9f},
    {Emotion::sadness, Flex::smile, -0.7f},  {Emotion::sadness, Flex::lids, -0.4f},
    {Emotion::anger, Flex::brows, -1},       {Emotion::anger, Flex::sneer, 0.3f},
    {Emotion::anger, Flex::smile, -0.3f},    {Emotion::fear, Flex::brows, 0.8f},
    {Emotion::fear, Flex::blink, -0.9f},     {Emotion::fear, Flex::say_ah, 0.4f},
    {Emotion::fear, Flex::say_oo, -0.3f},    {Emotion::disgust, Flex::sneer, 1},
    {Emotion::disgust, Flex::smile, -0.3f},  {Emotion::disgust, Flex::brows, -0.3f},
    {Emotion::surprise, Flex::brows, 1},     {Emotion::surprise, Flex::blink, -0.8f},
    {Emotion::surprise, Flex::say_ah, 0.9f}, {Emotion::surprise, Flex::say_oo, 0.1f}};

}  // namespace

void set_target(PerlinFace& face, Flex flex, float target) {
  if (!std::isfinite(target)) target = 0;
  for (PerlinFace::Value& value : face.flex[size_t(flex)]) value.target = target;
}

void add_targets(PerlinFace& face, Emotion emotion, float weight) {
  if (!std::isfinite(weight)) return;
  for (const Share& share : shares)
    if (share.emotion == emotion)
      for (PerlinFace::Value& value : face.flex[size_t(share.flex)])
        value.target += weight * share.value;
}

int tick_perlin(PerlinFace& face, float stir, float settle_seconds, double now, float dt) {
  double rate = std::log(20.0) / std::max(double(settle_seconds), 1e-3);
  float left = float(std::exp(-rate * double(dt)));
  for (auto& sides : face.flex)
    for (PerlinFace::Value& value : sides)
      value.settled = value.target + (value.settled - value.target) * left;
  int drawn = 0;
  for (const Stir& given : stirs)
    for (size_t side = 0; side < 2; side++) {
      PerlinFace::Value& value = face.flex[size_t(given.flex)][side];
      if (!(stir > 0)) {
        value.noise = std::abs(value.noise) < 1e-4f ? 0 : value.noise * left;
        continue;
      }
      // What lies further back than e^-30 is forgotten.
      double span = std::min(double(dt), 30 / rate);
      double before = span < double(dt) ? 0 : double(value.noise);
      double scale = double(stir) * frames_a_second * double(given.amplitude);
      value.noise = float(integrate(given, side, before, rate, scale, now - span, now, drawn));
    }
  return drawn;
}

}  // namespace wellspring::avatar
