// SPDX-License-Identifier: Apache-2.0
#include "show/draw/make_picture_job.h"

#include <algorithm>

#include "base/rng.h"
#include "picture/compose_drawn.h"
#include "show/draw/pace.h"
#include "show/draw/sample_budget.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"

namespace wellspring {

namespace {

constexpr double slack = 0.0015;     // seconds kept free of every period
constexpr double least_share = 0.2;  // of a period that goes to samples, even if the rate suffers
constexpr double predicted_pictures = 2;
constexpr double settled_samples = 8;  // a pixel, after which the reference takes over

// Seconds of a picture's period that are left for samples.
double seconds_to_trace(const Show& show, const Visitor& visitor, int busy) {
  double period = (1 - moving_share(show)) / drawing_rate(show, visitor);
  double display = 0.001 * double(visitor.times.display + visitor.times.tonemap);
  return std::max((period - slack) / std::max(busy, 1) - display, least_share * period);
}

}  // namespace

PictureJob make_picture_job(const Show& show, const Visitor& visitor, int busy, Purpose purpose) {
  const VisitorPicture& picture = visitor.picture;
  const VisitorPlace& place = visitor.place;
  PictureJob order;
  order.time = show.time;
  order.time_us = show.time_us;
  order.tick = show.ticks;
  const View& now = place.last_view;
  order.expected = order.view = order.ahead = now;
  order.seq = place.seq;
  order.figure = sees_figure(show, now);
  order.camera_cuts = place.camera_cuts;
  order.still = show.time - place.moved_at > still_after;
  order.keep = show.settings.background;
  const PictureJob& before = picture.order;
  // Of a place that was never seen, nothing is known.
  bool seen = picture.drawn_at >= 0 && place.camera_cuts == before.camera_cuts;
  float guessed = seen ? picture.stats.filled + picture.stats.empty : 1;
  order.learns = show.pass.denoiser && in_steps(order);
  order.settled = order.learns
                      ? picture.rest.samples >= settled_samples
                      : wants_reference(show.time - place.moved_at, seen && before.settled,
                                        !seen || before.coarse, guessed, picture.stats.converged);
  order.reconstruct = order.learns && purpose == Purpose::reconstruction;
  order.samples_only = order.learns && purpose == Purpose::samples;
  bool fine = order.learns || wants_fine_light(order.still, !seen || before.coarse, guessed);
  order.attention = visitor.wants.attention;
  order.seed = mix64(show.ticks * 0x9e3779b9u + visitor.link->id);
  const bool moves = order.keep && !order.still && visitor.shown.frame_number > 0;
  if (moves) order.scale = plan_next_keyframe(show, visitor).scale;
  const View shown = scaled_view(now, order.scale);
  const double pixels = double(shown.width) * double(shown.height);
  DrawingCosts costs = drawing_costs(show, visitor);
  double factor = keyframe_cost(order.scale) / keyframe_cost(before.scale);
  costs.drawing_seconds *= factor, costs.light_seconds *= factor;
  order.samples = sample_budget(seconds_to_trace(show, visitor, busy), size_t(pixels), costs, fine);
  // When all is known, what changes is looked for.
  if (order.samples_only && has_all_samples(picture.rest))
    order.samples = samples_to_watch(order.samples);
  // Who moves is shown shapes and reflectances as they are, in light of half their resolution where
  // samples are few; who stops, until more is known.
  double interval = 1 / drawing_rate(show, visitor);
  double seen_for = std::max(interval, 0.001 * double(visitor.times.interval));
  order.passing = !fine;
  order.coarse = order.passing && !affords_fine_light(order.samples / (seen_for * pixels),
                                                      before.passing && !before.coarse);
  if (moves) {
    // It is seen from when it is finished until the next one is.
    interval = seen_for;
    double seen_in = 0.001 * double(visitor.times.whole) + 0.5 * interval;
    order.expected = expected_view(place.heading, now, seen_in);
    order.ahead = expected_view(place.heading, now, seen_in + interval);
    float turn = expected_turn(place.heading, now, 0.5 * interval);
    order.view = scaled_view(keyframe_view(order.expected, turn), order.scale);
    if (order.passing) {
      order.ahead = scaled_view(keyframe_view(order.ahead), order.scale);
      order.around = surroundings(place.heading, now, order.view, seen_in + 0.5 * interval);
    }
  } else {
    order.ahead = expected_view(place.heading, now, predicted_pictures * interval);
  }
  return order;
}

bool is_outdated(const Show& show, const PictureJob& order, const Visitor& visitor) {
  if (visitor.left || visitor.place.camera_cuts != order.camera_cuts) return true;
  bool has_one =
      visitor.picture.drawn_at >= 0 && visitor.picture.order.camera_cuts == order.camera_cuts;
  return has_one && order.still &&
         (visitor.place.last_view != order.expected || lamps_wait(show) ||
          order.figure != sees_figure(show, visitor.place.last_view));
}

}  // namespace wellspring
