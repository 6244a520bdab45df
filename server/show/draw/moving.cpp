// SPDX-License-Identifier: Apache-2.0
#include "show/draw/moving.h"

#include <algorithm>

#include "base/clock.h"
#include "base/rng.h"
#include "show/state/in_view.h"
#include "show/draw/picture.h"
#include "show/draw/present.h"

namespace wellspring {
namespace {

constexpr double most_share = 0.5;   // of the time
constexpr double on_time = 0.0005;   // seconds that it may come too early
constexpr double skin_rate = 5;      // times a second that light on what moves is found
constexpr double most_skin_seconds = 0.025;  // of tracing, each time; when there are
constexpr float enough_samples = 8;          // of a place, less, but
constexpr double least_share = 0.25;         // of that at least: she moves
constexpr int cycles = 2, first_cycles = 6;  // of smoothing; when it was not found for a while

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

bool wants_skin(const Show& show) {
  if (show.skin.places.empty() || show.time - show.easel.skin.time < 1 / skin_rate - on_time)
    return false;
  return std::any_of(show.visitors.begin(), show.visitors.end(), [&](const Visitor& visitor) {
    return visitor.welcomed && sees_figure(show, visitor.last_view);
  });
}

void order_skin(Show& show) {
  SkinOrder& order = show.easel.skin;
  order.update = {};
  order.eyes.clear();
  for (const Visitor& visitor : show.visitors)
    if (visitor.welcomed) order.eyes.push_back(visitor.last_view.position);
  order.update.eyes = order.eyes;
  double seconds = most_skin_seconds *
                   std::clamp(double(enough_samples / show.skin.samples), least_share, 1.0);
  order.update.samples = int(seconds * double(show.samples_per_second));
  order.update.seed = mix64(show.ticks);
  order.update.transport = show.settings.transport;
  order.update.transport.clamp = show.settings.moving_clamp;
  order.cycles = show.time - order.time > 1 ? first_cycles : cycles;
  order.time = show.time;
  order.at_work = true;
}

void light_skin(Show& show) {
  SkinOrder& order = show.easel.skin;
  order.traced = size_t(update_skin(*show.world, show.lights, order.update, show.skin));
  smooth_skin(*show.world, show.skin, order.cycles);
}

void finish_skin(Show& show) {
  show.easel.skin.at_work = false;
  show.totals.samples += show.easel.skin.traced;
}

void draw_moving(Show& show, Visitor& visitor) {
  Easel& easel = show.easel;
  double began = seconds_now();
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
