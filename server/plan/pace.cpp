// SPDX-License-Identifier: Apache-2.0
#include "plan/pace.h"

#include <algorithm>

namespace wellspring::plan {
namespace {

// These are the constants of the same names, or of the same meaning, in server/show/draw.
constexpr double scales[] = {1, 0.75, 0.5, 0.375};
constexpr double sample_share = 0.3, climbing = 0.7, shortest_period = 1 / 30.0;
constexpr double finished_period = 0.1, least_local_period = 0.1, most_local_period = 1 / 3.0;
// Keyframes a second that a turn of 1.5 radians a second needs in a picture as wide as those.
constexpr double turning_rate = 0.1 / 0.0135;
constexpr double slack = 0.0015, least_share = 0.2, least_light = 0.25;
constexpr double least_sampling_rate = 0.75;
constexpr double warping_share = 0.5, most_finished = 60, least_finished = 1;

}  // namespace

KeyframePace pace_keyframe(double seconds, int walkers, double before, double longest) {
  const double all = seconds * std::max(walkers, 1), most = (1 - sample_share) * longest;
  double scale = scales[3];
  for (const double one : scales) {
    if (all * one / before > (one > before ? climbing : 1) * most) continue;
    scale = one;
    break;
  }
  return {scale, std::clamp(all * scale / before / (1 - sample_share), shortest_period, longest)};
}

double longest_use(bool local, bool turns) {
  if (!local) return finished_period;
  return turns ? std::clamp(1 / turning_rate, least_local_period, most_local_period)
               : most_local_period;
}

double sampling_seconds(double drawing, double period, int waiting, int walkers, double least,
                        double most) {
  period = std::min(period, 1 / least_sampling_rate);
  const double busy = std::max({waiting, walkers, 1});
  double floor = least_share * period;
  if (walkers > 1) floor = std::max(floor / walkers, least_share * drawing);
  const double seconds = std::max((period - slack) / busy, floor);
  const double tracing = std::max(seconds - drawing, least_light * seconds);
  return std::max(std::clamp(tracing, 0.0, most), std::min(least, most));
}

double finished_rate(double showing) {
  const double rate = showing > 0 ? warping_share / showing : most_finished;
  return std::clamp(rate, least_finished, most_finished);
}

}  // namespace wellspring::plan
