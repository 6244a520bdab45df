// SPDX-License-Identifier: Apache-2.0
#include "show/draw/picture.h"

#include <algorithm>

#include "base/clock.h"
#include "base/memory.h"
#include "base/rng.h"
#include "cache/trace_waiting.h"
#include "picture/compose_drawn.h"
#include "picture/still/plan_still.h"
#include "picture/still/still_guides.h"
#include "show/state/in_view.h"
#include "show/draw/moving.h"
#include "show/draw/picture_samples.h"
#include "show/draw/present.h"
#include "show/draw/sample_budget.h"

namespace wellspring {

namespace {

constexpr double still_after = 0.25;   // seconds without motion until a picture counts as a still
constexpr double slack = 0.0015;       // seconds kept free of every period
constexpr double least_share = 0.2;    // of a period that goes to samples, even if the rate suffers
constexpr double backdrop_rate = 4;    // pictures a second of what does not move
constexpr double learning_rate = 1.5;  // of pictures before the first reconstruction,
constexpr double learning_backdrop_rate = 0.75;  // likewise of what does not move
constexpr float nearly_all = 0.999f;   // converged
constexpr double around_kept = 2;  // seconds that what lies around is good for: turns come in bouts
constexpr double predicted_pictures = 2;
constexpr double settled_samples = 8;  // a pixel, after which the reference takes over

void smooth(float& value, float sample, float share = 0.1f) { value += (sample - value) * share; }
// What resolution is decided by: follows a change of load within some three keyframes.
constexpr float soon = 0.3f;

// Seconds of a picture's period that are left for samples.
double seconds_to_trace(const Show& show, const Visitor& visitor, int busy) {
  double period = (1 - moving_share(show)) / drawing_rate(show, visitor);
  double display = 0.001 * double(visitor.times.display + visitor.times.tonemap);
  return std::max((period - slack) / std::max(busy, 1) - display, least_share * period);
}

DrawingCosts drawing_costs(const Show& show, const Visitor& visitor) {
  const StageTimes& times = visitor.times;
  auto seconds = [](float milliseconds) { return 0.001 * double(milliseconds); };
  return {show.samples_per_second, seconds(times.drawing), seconds(times.display + times.tonemap),
          seconds(times.light)};
}

KeyframePlan plan_next_keyframe(const Show& show, const Visitor& visitor) {
  const DrawingCosts costs = drawing_costs(show, visitor);
  double light = costs.light_seconds > 0 ? costs.light_seconds : costs.display_seconds;
  return plan_keyframe((costs.drawing_seconds + light) * std::max(count_moving(show), 1),
                       visitor.order.scale);
}

// Times measured in one resolution, as they are to be expected in another.
void carry_times(double factor, StageTimes& times) {
  for (float* one : {&times.drawing, &times.light, &times.whole, &times.interval})
    *one *= float(factor);
}

}  // namespace

int count_moving(const Show& show) {
  auto moves = [&](const Visitor& one) { return one.welcomed && !stands(show, one); };
  return int(std::count_if(show.visitors.begin(), show.visitors.end(), moves));
}

void watch(const Show& show, Visitor& visitor) {
  View view = view_of(show, visitor);
  if (view != visitor.last_view) {
    visitor.moved_at = show.time;
    visitor.rest = {};
  }
  if (note_view(visitor.heading, show.time, view)) visitor.leaps++;
  visitor.last_view = view;
}

bool stands(const Show& show, const Visitor& visitor) {
  return visitor.frame_number > 0 && show.time - visitor.moved_at > still_after &&
         visitor.velocity == vec3(0) && visitor.move == vec3(0);
}

bool rests(const Show& show, const Visitor& visitor) {
  if (!stands(show, visitor) || sees_figure(show, visitor.last_view)) return false;
  return keeps_picture(show, visitor) ? has_all_samples(visitor.rest)
                                      : visitor.stats.converged >= nearly_all;
}

double drawing_rate(const Show& show, const Visitor& visitor) {
  double rate = picture_rate(show, visitor);
  if (!stands(show, visitor))
    return show.settings.background
               ? std::min(rate, 1 / plan_next_keyframe(show, visitor).period)
               : rate;
  if (visitor.backdrop) rate = backdrop_rate;
  // Until the first reconstruction, samples do more for it than pictures.
  bool first = show.pass.denoiser && !visitor.rest.reconstructed && !rests(show, visitor);
  first &= visitor.backdrop || !visitor.order.figure;
  return first ? std::min(rate, visitor.backdrop ? learning_backdrop_rate : learning_rate) : rate;
}

bool wants_drawing(const Show& show, const Visitor& visitor) {
  if (!visitor.welcomed || visitor.at_work || !may_take(show, visitor)) return false;
  if (visitor.leaps != visitor.order.leaps) return true;
  bool moves = show.settings.background && !stands(show, visitor);
  if (visitor.unshown && !moves) return false;
  if (show.pass.visitor == &visitor && !moves) return false;
  // Other light, or the storyteller came or went: who rests sees it at once.
  bool news = visitor.lamps != show.switches.lit ||
              visitor.order.figure != sees_figure(show, visitor.last_view);
  if (!moves && news) return true;
  double rate = moves ? picture_rate(show, visitor) : drawing_rate(show, visitor);
  return show.time - visitor.drawn_at >= 1 / rate - 0.0005;
}

bool is_outdated(const Show& show, const PictureOrder& order, const Visitor& visitor) {
  if (visitor.left || visitor.leaps != order.leaps) return true;
  bool has_one = visitor.drawn_at >= 0 && visitor.order.leaps == order.leaps;
  return has_one && order.still &&
         (visitor.last_view != order.expected || lamps_wait(show) ||
          order.figure != sees_figure(show, visitor.last_view));
}

PictureOrder order_picture(const Show& show, const Visitor& visitor, int busy) {
  PictureOrder order;
  order.time = show.time;
  order.time_us = show.time_us;
  order.tick = show.ticks;
  const View& now = visitor.last_view;
  order.expected = order.view = order.ahead = now;
  order.seq = visitor.seq;
  order.figure = sees_figure(show, now);
  order.leaps = visitor.leaps;
  order.still = show.time - visitor.moved_at > still_after;
  order.keep = show.settings.background;
  const PictureOrder& before = visitor.order;
  // Of a place that was never seen, nothing is known.
  bool seen = visitor.drawn_at >= 0 && visitor.leaps == before.leaps;
  float guessed = seen ? visitor.stats.filled + visitor.stats.empty : 1;
  bool learns = may_reconstruct(show, order);
  order.settled = learns ? visitor.rest.samples >= settled_samples
                         : wants_reference(show.time - visitor.moved_at, seen && before.settled,
                                           !seen || before.coarse, guessed,
                                           visitor.stats.converged);
  order.reconstruct = learns && wants_pass(show, visitor);
  order.samples_only = learns && !order.reconstruct && keeps_picture(show, visitor);
  bool fine = learns || wants_fine_light(order.still, !seen || before.coarse, guessed);
  order.attention = visitor.attention;
  order.seed = mix64(show.ticks * 0x9e3779b9u + visitor.link->id);
  const bool moves = order.keep && !order.still && visitor.frame_number > 0;
  if (moves) order.scale = plan_next_keyframe(show, visitor).scale;
  const View shown = scaled_view(now, order.scale);
  const double pixels = double(shown.width) * double(shown.height);
  DrawingCosts costs = drawing_costs(show, visitor);
  double factor = keyframe_cost(order.scale) / keyframe_cost(before.scale);
  costs.drawing_seconds *= factor, costs.light_seconds *= factor;
  order.samples =
      sample_budget(seconds_to_trace(show, visitor, busy), size_t(pixels), costs, fine);
  // When all is known, what changes is looked for.
  if (order.samples_only && has_all_samples(visitor.rest))
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
    order.expected = expected_view(visitor.heading, now, seen_in);
    order.ahead = expected_view(visitor.heading, now, seen_in + interval);
    float turn = expected_turn(visitor.heading, now, 0.5 * interval);
    order.view = scaled_view(keyframe_view(order.expected, turn), order.scale);
    if (order.passing) {
      order.ahead = scaled_view(keyframe_view(order.ahead), order.scale);
      order.around = surroundings(visitor.heading, now, order.view, seen_in + 0.5 * interval);
    }
  } else {
    order.ahead = expected_view(visitor.heading, now, predicted_pictures * interval);
  }
  return order;
}

namespace {

// What moves is drawn by itself where that is little of the picture, as what it covers is kept.
bool draws_backdrop(const Show& show, const PictureOrder& order) {
  if (!in_steps(order) || !order.figure || order.passing) return false;
  if (!show.sight->rasterises(order.view)) return false;
  PictureWindow window = moving_window(*show.world, order.view);
  return !window.empty() && may_be_laid_over(window, order.view);
}

DrawingStep plan_picture(Show& show, const PictureOrder& order, const Technique& technique,
                         const View& lit, Visitor& visitor) {
  DrawingWork& work = show.easel.work;
  PictureCosts& costs = visitor.costs = {};
  double began = seconds_now();
  plan_samples(show, order, technique, lit, work, visitor);
  double planned = seconds_now();
  costs.display = float(1000 * (planned - began));
  bool more = false;
  if (begin_samples(show, order, technique, lit, work, visitor) && !show.easel.given_up) {
    more = trace_slice(show, order, technique, work);
  }
  costs.trace = float(1000 * (seconds_now() - planned));
  return more ? DrawingStep::trace : DrawingStep::draw;
}

DrawingStep trace_more(Show& show, const PictureOrder& order, const Technique& technique,
                       Visitor& visitor) {
  double began = seconds_now();
  bool more = trace_slice(show, order, technique, show.easel.work);
  visitor.costs.trace += float(1000 * (seconds_now() - began));
  return more ? DrawingStep::trace : DrawingStep::draw;
}

DrawingStep paint_picture(Show& show, const PictureOrder& order, const View& lit,
                          Visitor& visitor) {
  RenderCache& cache = visitor.cache;
  Compositor& compositor = visitor.compositor;
  DrawingWork& work = show.easel.work;
  PictureCosts& costs = visitor.costs;
  double began = seconds_now();
  remember_traced(show, order, lit, work, visitor);
  if (order.samples_only) {
    cache.end_frame();
    return DrawingStep::done;
  }
  const Tonemap curve{show.exhibit.exposure};
  costs.backdrop = draws_backdrop(show, order);
  if (order.passing)
    compositor.draw(cache, order.view, *show.sight, curve, work.picture,
                    order.keep ? &work.depth : nullptr);
  else
    compositor.draw_still(cache, order.view, *show.sight, work.frame,
                          costs.backdrop ? StillShows::backdrop : StillShows::all);
  if (order.reconstruct) {
    std::swap(work.frame, show.pass.frame);
    work.guided = 0;
    costs.guide_seconds = seconds_now() - began;
    return DrawingStep::guide;
  }
  double painted = seconds_now();
  if (!order.passing) tonemap(work.frame, curve, work.picture);
  if (order.keep)
    make_keyframe(order.view, work.picture, order.passing ? work.depth : work.frame.depth,
                  work.keyframe);
  double finished = seconds_now();

  costs.drawing = compositor.drawing_ms();
  costs.display += float(1000 * (painted - began)) - costs.drawing;
  costs.tonemap = float(1000 * (finished - painted));
  if (order.passing)
    costs.light = std::exchange(costs.display, 0.0f) + std::exchange(costs.tonemap, 0.0f);
  return DrawingStep::done;
}

// One visibility pass of a reconstruction's guides; the last also encodes its input.
DrawingStep find_guides(Show& show, const PictureOrder& order, Visitor& visitor) {
  DrawingWork& work = show.easel.work;
  StillPass& pass = show.pass;
  double began = seconds_now();
  bool all = work.guided == guide_places;
  if (!all)
    add_still_guides(*show.world, show.lights, *show.sight, order.view,
                     visitor.costs.backdrop ? RasterShows::still : RasterShows::all, work.guided++,
                     pass.work.guides, pass.work.followed);
  else
    begin_reconstruction(visitor.compositor.samples(), pass.frame, *pass.denoiser, pass.work);
  visitor.costs.guide_seconds += seconds_now() - began;
  return all ? DrawingStep::done : DrawingStep::guide;
}

}  // namespace

bool in_steps(const PictureOrder& order) { return order.still && order.keep; }

bool may_reconstruct(const Show& show, const PictureOrder& order) {
  return show.pass.denoiser && in_steps(order);
}

DrawingStep draw_step(Show& show, const PictureOrder& order, DrawingStep step, Visitor& visitor) {
  double began = seconds_now();
  const Technique& technique = order.settled ? *show.still_technique : *show.technique;
  const View lit = order.coarse ? light_view(order.view) : order.view;
  if (step == DrawingStep::plan) {
    step = plan_picture(show, order, technique, lit, visitor);
  } else if (show.easel.given_up) {
    if (step != DrawingStep::guide) remember_traced(show, order, lit, show.easel.work, visitor);
    visitor.costs.given_up = true;
    step = DrawingStep::done;
  } else if (step == DrawingStep::trace) {
    step = trace_more(show, order, technique, visitor);
  } else if (step == DrawingStep::draw) {
    step = paint_picture(show, order, lit, visitor);
  } else {
    step = find_guides(show, order, visitor);
  }
  visitor.costs.seconds += seconds_now() - began;
  return step;
}

void draw_picture(Show& show, const PictureOrder& order, Visitor& visitor) {
  for (DrawingStep step = DrawingStep::plan; step != DrawingStep::done;)
    step = draw_step(show, order, step, visitor);
}

// What was drawn in the memory of somebody else's larger picture does not keep it.
static void fit_memory(Visitor& visitor) {
  auto fit = [](auto& v) {
    if (v.capacity() > v.size() + v.size() / 4) v.shrink_to_fit();
  };
  for (Keyframe* keyframe : {&visitor.keyframe, &visitor.around})
    fit(keyframe->color), fit(keyframe->disparity), fit(keyframe->farthest), fit(keyframe->nearest);
  fit(visitor.picture.rgb);
}

size_t memory_bytes(const DrawingWork& work) {
  return memory_bytes(*work.cache) + memory_bytes(*work.compositor) + memory_bytes(work.frame) +
         memory_bytes(work.keyframe) + memory_bytes(work.around) +
         bytes_of(work.depth, work.picture.rgb, work.requests, work.ahead, work.samples) +
         memory_bytes(work.moving_light) + memory_bytes(work.moving);
}

void finish_picture(Show& show, const PictureOrder& order, Visitor& visitor) {
  const PictureCosts& costs = visitor.costs;
  StageTimes& times = visitor.times;
  if (costs.samples > 0 && costs.trace > 0)
    smooth(show.samples_per_second, float(costs.samples) / (0.001f * costs.trace));
  show.totals.samples += costs.samples;
  if (costs.given_up) {
    visitor.surrounded = false;
    show.totals.given_up++;
    return;
  }
  if (!costs.late) smooth(times.trace, costs.trace);
  if (order.samples_only || order.reconstruct) {
    visitor.drawn_at = order.time;
    visitor.order.settled = order.settled;
    if (order.reconstruct) begin_pass(show, order, visitor);
    show.easel.work_bytes = memory_bytes(show.easel.work) + memory_bytes(show.pass);
    return;
  }
  if (order.scale != visitor.order.scale)
    carry_times(keyframe_cost(order.scale) / keyframe_cost(visitor.order.scale), times);
  const float share = order.still ? 0.1f : soon;
  if (order.passing) {
    smooth(times.light, costs.light, share);
  } else {
    smooth(times.display, costs.display);
    smooth(times.tonemap, costs.tonemap);
  }
  smooth(times.drawing, costs.drawing, share);
  if (!order.still) smooth(times.whole, float(1000 * costs.seconds), share);
  double interval = order.time - visitor.drawn_at;
  if (interval > 0 && interval < 1) {
    smooth(visitor.drawn_fps, float(1 / interval));
    if (!order.still) smooth(times.interval, float(1000 * interval), share);
  }
  visitor.drawn_at = order.time;
  visitor.broker_seconds =
      costs.late ? double(order.samples) / std::max(double(show.samples_per_second), 1.0)
                 : 0;
  visitor.stats = visitor.cache.stats();
  visitor.cache_bytes = visitor.cache.memory_bytes() + visitor.compositor.memory_bytes();
  // Else its keyframe has the colours.
  if (!order.keep) std::swap(show.easel.work.picture, visitor.picture);
  std::swap(show.easel.work.keyframe, visitor.keyframe);
  visitor.surrounded = false;
  bool settles = order.still && !order.passing;  // samples of its pixels take that memory
  if (settles || order.leaps != visitor.around_leaps ||
      show.time - visitor.around_at > around_kept)
    visitor.around = {};
  fit_memory(visitor);
  visitor.memory_bytes = picture_memory(visitor);
  show.easel.work_bytes = memory_bytes(show.easel.work) + memory_bytes(show.pass);
  visitor.order = order;
  finish_backdrop(visitor);
  show.totals.drawn++;
}

void draw_surroundings(Show& show, const PictureOrder& order, Visitor& visitor) {
  DrawingWork& work = show.easel.work;
  follow_lamps(show, visitor);
  land(visitor.broker.collect(), *show.world, show.pose_number, visitor.cache);
  visitor.compositor.draw(visitor.cache, *order.around, *show.sight,
                          Tonemap{show.exhibit.exposure}, work.picture, &work.depth, true);
  make_keyframe(*order.around, work.picture, work.depth, work.around);
}

void finish_surroundings(Show& show, const PictureOrder& order, Visitor& visitor) {
  std::swap(show.easel.work.around, visitor.around);
  visitor.around_at = order.time;
  visitor.around_leaps = order.leaps;
  visitor.surrounded = true;
  fit_memory(visitor);
  visitor.memory_bytes = picture_memory(visitor);
  show.totals.surroundings++;
}

bool order_samples(Show& show) {
  Easel& easel = show.easel;
  easel.brokers.clear();
  easel.seconds = 0;
  for (Visitor& visitor : show.visitors) {
    if (visitor.broker_seconds <= 0) continue;
    easel.brokers.push_back(&visitor.broker);
    easel.seconds += std::exchange(visitor.broker_seconds, 0.0);
    visitor.at_work = true;
  }
  return !easel.brokers.empty();
}

void trace_samples(const Show& show, Easel& easel) {
  std::mutex guard;
  double began = seconds_now();
  easel.traced = trace_waiting(easel.brokers, *show.world, show.lights, show.pose_number,
                               began + easel.seconds, guard);
  easel.traced_seconds = seconds_now() - began;
}

void finish_samples(Show& show) {
  Easel& easel = show.easel;
  show.totals.samples += easel.traced;
  if (easel.traced > 0 && easel.traced_seconds > 0)
    smooth(show.samples_per_second, float(double(easel.traced) / easel.traced_seconds));
  for (Visitor& visitor : show.visitors) {
    auto found = std::find(easel.brokers.begin(), easel.brokers.end(), &visitor.broker);
    if (found == easel.brokers.end()) continue;
    smooth(visitor.times.trace, float(1000 * easel.traced_seconds / double(easel.brokers.size())));
    visitor.at_work = false;
  }
  easel.brokers.clear();
}

}  // namespace wellspring
