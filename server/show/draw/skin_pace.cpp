// SPDX-License-Identifier: Apache-2.0
#include "show/draw/skin_pace.h"

#include <algorithm>
#include <cmath>

namespace wellspring::show {
namespace {

constexpr double most_skin_seconds = 0.025;  // of tracing, each time; when there are
constexpr float enough_samples = 8;          // of a place, less, but
constexpr double least_skin_share = 0.25;    // of that at least: it moves
constexpr double samples_a_pixel = 0.25;     // each time, when it has none
constexpr float large = 60e3f;               // pixels: what is larger is lit as often as ever
constexpr double most_slower = 5;            // times least_interval

}  // namespace

SkinPace plan_skin(float pixels, double samples_per_second, float known) {
  if (!(pixels > 0)) return {0, least_interval};
  const double share = std::clamp(double(enough_samples / known), least_skin_share, 1.0);
  const double samples =
      share * std::min(most_skin_seconds * samples_per_second, samples_a_pixel * double(pixels));
  const double slower = std::clamp(std::sqrt(double(large / pixels)), 1.0, most_slower);
  return {std::max(int(samples), 1), least_interval * slower};
}

}  // namespace wellspring::show
