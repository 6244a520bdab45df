// SPDX-License-Identifier: Apache-2.0
#include "show/draw/sample_budget.h"

#include <algorithm>
#include <iterator>

namespace wellspring::show {
namespace {

constexpr double unmeasured_light = 0.4;  // of the display's time, for who moves
constexpr double least_light = 0.25;      // of the time goes to light, whatever is drawn
constexpr double least_samples = 1000;    // a picture, however slow the machine
constexpr double most_a_pixel = 0.5;
constexpr double aimed_share = 0.0625;  // of the samples at rest
constexpr float nearly_none = 0.1f;     // of the picture's pixels
constexpr float most_known = 0.5f;      // likewise
constexpr double settled_after = 2;     // seconds
constexpr float keyframe_scales[] = {1, 0.75f, 0.5f, 0.375f};
constexpr double shortest_period = 1 / 30.0;  // seconds from keyframe to keyframe
// FLIP, in the mean of the picture, that a keyframe's age may add, and what a picture adds that is
// wrong all over (cache.warp, stroll and orbit at 300 ms) or as soft as the wide keyframe.
constexpr float borne = 0.0135f, of_uncovered = 0.45f, of_turned_to = 0.1f;
constexpr double least_local_period = 1 / 10.0, most_local_period = 1 / 3.0;
constexpr double sample_share = 0.3;  // of that time, at least
constexpr double climbing = 0.7;      // of the time allowed, when a larger keyframe is drawn again
constexpr float most_uncovered = 0.2f;  // of a picture's width, by a tour's turn

}  // namespace

int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool stands) {
  double display = costs.display_seconds;
  if (!stands) display = costs.light_seconds > 0 ? costs.light_seconds : unmeasured_light * display;
  double tracing = std::max(seconds + costs.display_seconds - display - costs.drawing_seconds,
                            least_light * seconds);
  // Who stands gains by light what fewer pictures cost; who moves, by pictures.
  if (stands)
    tracing =
        std::max(tracing, least_light / (1 - least_light) * (display + costs.drawing_seconds));
  double samples =
      std::clamp(tracing * costs.samples_per_second, 0.0, most_a_pixel * double(pixels));
  return int(std::max(samples, std::min(least_samples, double(pixels))));
}

int samples_to_watch(int samples) { return int(aimed_share * samples); }

double keyframe_cost(float scale) { return double(scale); }

double longest_period(const Ageing& ageing) {
  const float error = of_uncovered * ageing.uncovered + of_turned_to * ageing.turned_to;
  if (!(error > 0)) return most_local_period;  // or it is not known
  return std::clamp(double(borne / error), least_local_period, most_local_period);
}

KeyframePlan plan_keyframe(double seconds, float before, double longest_period) {
  const double most = (1 - sample_share) * longest_period;
  auto cost = [&](float scale) { return seconds * keyframe_cost(scale) / keyframe_cost(before); };
  auto fits = [&](float scale) { return cost(scale) <= (scale > before ? climbing * most : most); };
  const float* found = std::find_if(std::begin(keyframe_scales), std::end(keyframe_scales), fits);
  float scale = found == std::end(keyframe_scales) ? *std::prev(found) : *found;
  return {scale, std::clamp(cost(scale) / (1 - sample_share), shortest_period, longest_period)};
}

float tour_pace(float turn, float fov) {
  float most = most_uncovered * fov;
  return turn > most ? most / turn : 1.0f;
}

bool wants_reference(double seconds_at_rest, bool before, float guessed, float known) {
  if (seconds_at_rest <= settled_after) return false;
  return before || (guessed <= nearly_none && known >= most_known);
}

}  // namespace wellspring::show
