// SPDX-License-Identifier: Apache-2.0
#include "show/display_path.h"

#include <algorithm>

#include "cache/looks.h"

namespace wellspring {
namespace {

constexpr double edge_share = 0.12;                   // of the time, on path `cache`
constexpr double enter_primary = 0.4, leave_primary = 0.55;  // of the time, for all pixels' looks
constexpr double enter_drawn = 0.6, leave_drawn = 0.8;  // of the time, for drawing
// Seconds a picture may take with it. On a busy machine points are few, and what they show is worse
// than fewer pictures.
constexpr double enter_period = 0.5, leave_period = 0.6;
constexpr double unmeasured_light = 0.4;  // of the display's time, where light is coarser
constexpr double least_light = 0.25;  // of the time goes to light, whatever is drawn
constexpr int drawn_samples =
    1000;  // the same where shapes are drawn: only light has to be guessed
constexpr int least_samples = 2000;                   // a picture, however slow the machine
// Samples a second for each pixel, from which on finer light shows who moves less error, though
// most of its pixels have no point.
constexpr double enter_fine = 0.4, leave_fine = 0.25;
constexpr float few_guessed = 0.25f;   // of the pixels of coarser light: some 1.4 samples each
constexpr float nearly_none = 0.1f;    // of the picture's pixels
constexpr float most_known = 0.5f;     // likewise
constexpr double settled_after = 2;    // seconds

int whole(double count, double most) { return int(std::clamp(count, 0.0, most)); }

}  // namespace

DisplayPlan plan_display(double seconds, size_t pixels, const DisplayCosts& costs,
                         const DisplayPlan& before, bool fine, DrawShapes wish) {
  DisplayPlan plan;
  double all_looks = double(pixels) * looks_a_pixel;
  double all_seconds = all_looks / std::max(costs.looks_per_second, 1.0);
  plan.primary = all_seconds <= (before.primary ? leave_primary : enter_primary) * seconds;
  double drawing = costs.drawing_seconds;
  double light =
      std::max(least_light * seconds, drawn_samples / std::max(costs.samples_per_second, 1.0));
  double display = costs.display_seconds;
  if (!fine) display = costs.light_seconds > 0 ? costs.light_seconds : unmeasured_light * display;
  double period = display + drawing + light;
  plan.drawn = drawing <= (before.drawn ? leave_drawn : enter_drawn) * seconds ||
               period <= (before.drawn ? leave_period : enter_period);
  if (wish != DrawShapes::automatic) plan.drawn = wish == DrawShapes::always;
  plan.drawn &= !plan.primary;
  if (plan.drawn)
    seconds = std::max(seconds + costs.display_seconds - display - drawing, least_light * seconds);
  // Who stands gains by light what fewer pictures cost; who moves, by pictures.
  if (plan.drawn && fine)
    seconds = std::max(seconds, least_light / (1 - least_light) * (display + drawing));
  double look_seconds = plan.primary ? all_seconds : plan.drawn ? 0 : edge_share * seconds;
  plan.looks =
      plan.primary ? int(all_looks) : whole(look_seconds * costs.looks_per_second, all_looks);
  plan.samples = std::max(
      whole((seconds - look_seconds) * costs.samples_per_second, 0.5 * double(pixels)),
      std::min(plan.drawn ? drawn_samples : least_samples, int(pixels)));
  return plan;
}

bool wants_fine_light(bool stands, bool coarse, float guessed) {
  return stands && !(coarse && guessed > few_guessed);
}

bool affords_fine_light(double samples, bool before) {
  return samples >= (before ? leave_fine : enter_fine);
}

bool wants_reference(double seconds_at_rest, bool before, bool coarse, float guessed, float known) {
  if (seconds_at_rest <= settled_after || coarse) return false;
  return before || (guessed <= nearly_none && known >= most_known);
}

}  // namespace wellspring
