// SPDX-License-Identifier: Apache-2.0
#include "show/state/delivery.h"
#include "show/state/visitor_picture.h"

#include <algorithm>

namespace wellspring::show {

// Limits, a second, for a page that draws by itself: keyframes of a walk, and layers of moving
// things.
static constexpr double most_keyframes = 10, most_layers = 25;

bool takes_pictures(const Visitor& visitor, double time) {
  return !visitor.link->picture_pending() && may_send(visitor.shown.flow, time);
}

FlowWishes flow_wishes(const ShowSettings& settings, const Visitor& visitor) {
  const PictureWishes& wants = visitor.wants;
  double rate = wants.fps > 0 ? double(wants.fps) : double(settings.fps);
  if (wants.local)
    rate = std::min(rate, is_still(visitor.picture->job) ? most_layers : most_keyframes);
  return {wants.best_quality, rate, double(wants.width) * wants.height, wants.bandwidth};
}

PicturePlan picture_plan(const ShowSettings& settings, const Visitor& visitor) {
  const FlowWishes wishes = flow_wishes(settings, visitor);
  PicturePlan plan = plan_picture(visitor.shown.way, visitor.shown.flow, wishes);
  if (visitor.wall.tiles.empty()) return plan;
  plan.rate = wishes.rate;  // a camera has no line of its own
  for (const Visitor* tile : visitor.wall.tiles)
    plan.rate = std::min(plan.rate, picture_plan(settings, *tile).rate);
  return plan;
}

}  // namespace wellspring::show
