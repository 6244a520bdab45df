// SPDX-License-Identifier: Apache-2.0
#include "show/moving.h"

#include <algorithm>

#include "base/clock.h"
#include "show/in_view.h"
#include "show/picture.h"
#include "show/present.h"

namespace wellspring {
namespace {

constexpr double most_share = 0.35;  // of the time
constexpr double on_time = 0.0005;   // seconds that it may come too early

bool has_backdrop(const Show& show, const Visitor& visitor) {
  return visitor.welcomed && visitor.backdrop && visitor.order.leaps == visitor.leaps &&
         visitor.order.view == visitor.last_view && stands(show, visitor);
}

// Pictures a second, for each of those who have a backdrop.
double moving_rate(const Show& show, const Visitor& visitor) {
  auto has = [&](const Visitor& one) { return has_backdrop(show, one); };
  auto count = std::count_if(show.visitors.begin(), show.visitors.end(), has);
  double seconds = 0.001 * double(visitor.times.moving) * double(std::max<ptrdiff_t>(count, 1));
  double rate = picture_rate(show, visitor);
  return seconds > 0 ? std::min(rate, most_share / seconds) : rate;
}

}  // namespace

bool may_be_laid_over(const PictureWindow& window, const View& view) {
  return 3 * size_t(window.width) * size_t(window.height) <=
         size_t(view.width) * size_t(view.height);
}

double moving_share(const Show& show) {
  double share = 0;
  for (const Visitor& visitor : show.visitors)
    if (has_backdrop(show, visitor))
      share += 0.001 * double(visitor.times.moving) * moving_rate(show, visitor);
  return std::min(share, most_share);
}

bool wants_moving(const Show& show, const Visitor& visitor) {
  if (!has_backdrop(show, visitor) || visitor.unshown || !may_take(show, visitor)) return false;
  return show.time - visitor.posed_at >= 1 / moving_rate(show, visitor) - on_time;
}

double seconds_to_moving(const Show& show) {
  double seconds = 1;
  for (const Visitor& visitor : show.visitors)
    if (has_backdrop(show, visitor))
      seconds =
          std::min(seconds, visitor.posed_at + 1 / moving_rate(show, visitor) - show.time);
  return std::max(seconds, 0.0);
}

void draw_moving(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  double began = seconds_now();
  easel.moving_known = visitor.compositor.draw_moving(
      visitor.cache, *show.world, visitor.keyframe, *show.sight, Tonemap{show.exhibit.exposure},
      easel.work.moving_light, easel.work.moving);
  easel.posed_seconds = seconds_now() - began;
}

void finish_moving(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  visitor.posed_at = easel.posed_at;
  MovingPicture& moving = easel.work.moving;
  // Else all of it is drawn anew.
  visitor.backdrop &= easel.moving_known && may_be_laid_over(moving.window, moving.view);
  if (!visitor.backdrop) return;
  float& smoothed = visitor.times.moving;
  float milliseconds = float(1000 * easel.posed_seconds);
  smoothed = smoothed > 0 ? smoothed + (milliseconds - smoothed) * 0.1f : milliseconds;
  std::swap(moving, visitor.moving);
  visitor.order.time_us = easel.posed_us;
  visitor.unshown = true;
  show.totals.posed++;
}

void finish_backdrop(Visitor& visitor) {
  visitor.backdrop = visitor.costs.backdrop;
  visitor.unshown = !visitor.backdrop;
  visitor.posed_at = -1e9;
  if (!visitor.backdrop || visitor.moving.view != visitor.keyframe.view) visitor.moving = {};
}

void merge_moving(Visitor& visitor) {
  if (visitor.moving.empty()) return;
  lay_over(visitor.moving, visitor.keyframe);
  visitor.moving = {};
  visitor.backdrop = false;
}

}  // namespace wellspring
