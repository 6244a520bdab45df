// SPDX-License-Identifier: Apache-2.0
#include "show/moving.h"

#include <algorithm>

#include "base/clock.h"
#include "base/rng.h"
#include "show/in_view.h"
#include "show/picture.h"
#include "show/present.h"

namespace wellspring {
namespace {

constexpr double most_share = 0.5;   // of the time
constexpr double on_time = 0.0005;   // seconds that it may come too early
constexpr double skin_rate = 10;     // times a second that light on what moves is found
constexpr double skin_share = 0.3;  // of the time, for its samples
constexpr int cycles = 2, first_cycles = 6;  // of smoothing; when it was not found for a while
constexpr double least_skin_samples = 200, most_skin_seconds = 0.25;

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

void order_skin(Show& show) {
  SkinOrder& order = show.easel.skin;
  show.totals.samples += std::exchange(order.traced, 0);
  order.wanted = !show.skin.places.empty() && show.storyteller_visible &&
                 show.time - order.time >= 1 / skin_rate - on_time;
  if (!order.wanted) return;
  order.eyes.clear();
  for (const Visitor& visitor : show.visitors)
    if (visitor.welcomed) order.eyes.push_back(visitor.last_view.position);
  double seconds = std::min(show.time - order.time, most_skin_seconds);
  order.cycles = show.time - order.time > 1 ? first_cycles : cycles;
  order.samples =
      int(std::max(skin_share * seconds * double(show.samples_per_second), least_skin_samples));
  order.time = show.time;
  order.seed = mix64(show.ticks);
}

void light_skin(Show& show) {
  SkinOrder& order = show.easel.skin;
  if (!std::exchange(order.wanted, false)) return;
  SkinUpdate update;
  update.samples = order.samples;
  update.seed = order.seed;
  update.eyes = order.eyes;
  update.transport = show.settings.transport;
  update.transport.clamp = show.settings.moving_clamp;
  order.traced += size_t(update_skin(*show.world, show.lights, update, show.skin));
  smooth_skin(*show.world, show.skin, order.cycles);
}

void draw_moving(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  double began = seconds_now();
  light_skin(show);
  visitor.compositor.draw_moving(*show.world, visitor.keyframe, *show.sight,
                                 Tonemap{show.exhibit.exposure}, easel.work.moving_light,
                                 easel.work.moving);
  easel.posed_seconds = seconds_now() - began;
}

void finish_moving(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  visitor.posed_at = easel.posed_at;
  MovingPicture& moving = easel.work.moving;
  // Else all of it is drawn anew.
  visitor.backdrop &= may_be_laid_over(moving.window, moving.view);
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
