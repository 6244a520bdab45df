// SPDX-License-Identifier: Apache-2.0
#include "show/draw/make_picture_job.h"

#include <algorithm>

#include "base/rng.h"
#include "picture/compose_drawn.h"
#include "show/draw/decide.h"
#include "show/draw/pace.h"
#include "show/draw/steer.h"
#include "show/lens/lens.h"
#include "show/lens/pieces.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "show/workers/send.h"

namespace wellspring::show {

namespace {

constexpr double slack = 0.0015;  // seconds kept free of every period
// share of a period that goes to samples, even if the rate suffers
constexpr double least_share = 0.2;
// pictures a second: rarer ones are given no more samples
constexpr double least_sampling_rate = 0.75;
constexpr double predicted_pictures = 2;
constexpr double turn_ahead_seconds = 0.3;  // seconds for which a wide keyframe looks ahead
constexpr double settled_samples = 8;       // samples a pixel, after which the reference takes over
constexpr int samples_at_once = 1000;       // samples of a picture that is to be there at once

// Returns the seconds of a picture's period that are left for samples.
double seconds_to_trace(const Show& show, const Visitor& visitor, int busy) {
  const int walkers = count_moving(show.visits, show.time);
  if (!stands(show.time, visitor)) busy = std::max(busy, walkers);
  double period =
      (1 - moving_share(show)) / std::max(drawing_rate(show, visitor), least_sampling_rate);
  double display = 0.001 * double(visitor.times.display + visitor.times.tonemap);
  double least = least_share * period;
  // If many walk, keyframes come late enough without samples: the time that one keyframe takes is
  // what counts.
  if (walkers > 1)
    least =
        std::max(least / walkers,
                 least_share * drawing_costs(show.visits, *show.drawing, visitor).drawing_seconds);
  return std::max((period - slack) / std::max(busy, 1) - display, least);
}

}  // namespace

PictureJob make_picture_job(const Show& show, const Visitor& visitor, int busy,
                            PictureKind wanted) {
  const VisitorPicture& picture = *visitor.picture;
  const VisitorPlace& place = visitor.place;
  PictureJob job;
  job.time = show.time;
  job.time_us = show.time_us;
  job.tick = show.ticks;
  const View& now = place.last_view;
  job.expected = job.view = job.ahead = now;
  job.seq = place.seq;
  job.sees_moving = sees_moving(show.cast, show.visits, visitor, now);
  job.sways = visitor.lawns.sways;
  job.camera_cuts = place.camera_cuts;
  job.rest = picture.rest;
  // The first picture of a place, while others walk, is to be there soon.
  const bool hurried = place.camera_cuts != picture.job.camera_cuts &&
                       count_moving(show.visits, show.time) > int(!stands(show.time, visitor));
  job.dynamic = visitor.dynamic;
  job.pieces = visitor.pieces.shown;
  // Over pictures at rest, the light of dynamic lights is put with moving things
  // (show/draw/still_pass.h).
  const bool put_over = show.stage.visibility->rasterises(now);
  const bool still =
      !hurried && (job.dynamic.empty() || put_over) && show.time - place.moved_at > still_after;
  const PictureJob& before = picture.job;
  // Nothing is found yet of a place that was never seen.
  bool seen = picture.drawn_at >= 0 && place.camera_cuts == before.camera_cuts;
  float guessed = seen ? picture.stats.filled + picture.stats.empty : 1;
  const bool points = show.settings.display == Display::points;
  job.learns = show.drawing->pass.denoiser && still && !points;
  job.settled = job.learns ? picture.rest.samples >= settled_samples
                           : wants_reference(show.time - place.moved_at, seen && before.settled,
                                             guessed, picture.stats.converged);
  const bool stays = job.learns && wanted != PictureKind::moving;
  job.kind = !still ? PictureKind::moving : stays ? wanted : PictureKind::still;
  job.attention = visitor.wants.attention;
  job.weights = visitor.looks.weights;
  job.note_seen = wants_seen(show, visitor);
  job.seed = mix64(show.ticks * 0x9e3779b9u + visitor.link->id);
  const bool moves = !still && (hurried || visitor.shown.frame_number > 0);
  // After a leap nothing moves: pixels count for more than pictures a second.
  if (moves && (hurried || !place.leapt))
    job.scale = plan_next_keyframe(show.visits, *show.drawing, show.time, visitor).scale;
  const View shown = scaled_view(now, job.scale);
  const double pixels = double(shown.width) * double(shown.height);
  DrawingCosts costs = drawing_costs(show.visits, *show.drawing, visitor);
  double factor = keyframe_cost(job.scale) / keyframe_cost(before.scale);
  costs.drawing_seconds *= factor, costs.light_seconds *= factor;
  job.samples = sample_budget(seconds_to_trace(show, visitor, busy), size_t(pixels), costs, still);
  // When there are all samples, changes of the light are looked for.
  if (job.kind == PictureKind::samples && has_all_samples(picture.rest))
    job.samples = samples_to_watch(job.samples);
  // After a leap, maps light the first picture.
  const bool leaps = !still && place.leapt && !seen && show.stage.lights.maps;
  if (leaps || (still && is_wanted_at_once(picture, now)))
    job.samples = std::min(job.samples, samples_at_once);
  if (!has_all_samples(picture.rest)) job.away = room_of_workers(show, still);
  double interval = 1 / drawing_rate(show, visitor);
  if (moves) {
    // The picture is seen from when it is finished until the next one is.
    interval = std::max(interval, 0.001 * double(visitor.times.interval));
    double seen_in = 0.001 * double(visitor.times.whole) + 0.5 * interval;
    // The page goes on by itself, without waiting for the line.
    if (visitor.wants.local) seen_in += double(visitor.shown.flow.line_trip);
    job.expected = expected_view(place.heading, now, seen_in);
    job.ahead = expected_view(place.heading, now, seen_in + interval);
    float turn = expected_turn(place.heading, now, 0.5 * interval);
    job.view = scaled_view(keyframe_view(job.expected, turn), job.scale);
    job.ahead = scaled_view(keyframe_view(job.ahead), job.scale);
  } else {
    job.ahead = expected_view(place.heading, now, predicted_pictures * interval);
  }
  // A page that draws by itself turns before the server hears of it.
  const EyeMotion motion = motion_of(place.heading, now);
  const bool may_turn = visitor.wants.local || motion.speed + motion.turn > 0;
  if (!still && seen && !points && may_turn) {
    const Surroundings& around = picture.around;
    const bool here = around.camera_cuts == place.camera_cuts && !around.keyframe.empty();
    // A turn goes on until they are there.
    const View soon = expected_view(place.heading, now, turn_ahead_seconds);
    if (!here || is_elsewhere(around.keyframe.view, soon)) job.around = wide_view(soon);
  }
  return job;
}

bool is_outdated(const Show& show, const PictureJob& job, const Visitor& visitor) {
  if (visitor.left || visitor.place.camera_cuts != job.camera_cuts) return true;
  bool has_one =
      visitor.picture->drawn_at >= 0 && visitor.picture->job.camera_cuts == job.camera_cuts;
  return has_one && is_still(job) &&
         (visitor.place.last_view != job.expected || lamps_wait(show, visitor) ||
          moves_lens(show.time, visitor) || job.pieces != visitor.pieces.shown ||
          job.sees_moving != sees_moving(show.cast, show.visits, visitor, visitor.place.last_view));
}

}  // namespace wellspring::show
