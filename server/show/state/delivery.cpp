// SPDX-License-Identifier: Apache-2.0
#include "show/state/delivery.h"

namespace wellspring {

FlowWishes flow_wishes(const Show& show, const Visitor& visitor) {
  const PictureWishes& wants = visitor.wants;
  const double rate = wants.fps > 0 ? double(wants.fps) : double(show.settings.fps);
  return {wants.best_quality, rate, double(wants.width) * wants.height, wants.bandwidth};
}

PicturePlan picture_plan(const Show& show, const Visitor& visitor) {
  return plan_picture(visitor.shown.way, visitor.shown.flow, flow_wishes(show, visitor));
}

}  // namespace wellspring
