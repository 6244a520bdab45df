// SPDX-License-Identifier: Apache-2.0
#include "show/draw/pace.h"

#include <algorithm>
#include <cmath>
#include <oneapi/tbb/info.h>

#include "show/lens/pieces.h"
#include "show/state/delivery.h"
#include "show/lens/lens.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "show/draw/tiles.h"

namespace wellspring::show {
namespace {

constexpr double most_skin_seconds = 0.025;  // seconds of tracing each time, at most
constexpr float enough_samples = 8;          // samples of a place; with more, fewer are traced
constexpr double least_skin_share = 0.25;    // at least this share of them, as the thing moves
constexpr double samples_a_pixel = 0.25;     // samples each time, when a place has none
constexpr float large = 60e3f;               // pixels: larger things are lit as often as ever
constexpr double most_slower = 5;            // times least_interval, at most

}  // namespace

SkinPace plan_skin(float pixels, double samples_per_second, float known) {
  if (!(pixels > 0)) return {0, least_interval};
  const double share = std::clamp(double(enough_samples / known), least_skin_share, 1.0);
  const double samples =
      share * std::min(most_skin_seconds * samples_per_second, samples_a_pixel * double(pixels));
  const double slower = std::clamp(std::sqrt(double(large / pixels)), 1.0, most_slower);
  return {std::max(int(samples), 1), least_interval * slower};
}

namespace {

constexpr double still_rate = 25;    // pictures a second while only the storyteller moves
constexpr double swaying_rate = 12;  // likewise while only grass moves
constexpr double moved_rate = 2;     // likewise, and the page moves it in between
constexpr double settling_rate = 7;  // likewise while nothing moves: more time for samples
constexpr double resting_rate = 4;   // likewise when nothing in the picture changes any more
constexpr double rested_rate = 0.2;  // likewise, when nothing has changed for long
constexpr double settled_seconds = 5;
constexpr double backdrop_rate = 4;    // pictures a second without moving things
constexpr double closed_rate = 1;      // at a kiosk while the house is closed
constexpr double learning_rate = 1.5;  // pictures a second before the first reconstruction
constexpr double learning_backdrop_rate = 0.75;  // likewise without moving things
// share of the time, at most, for all visitors' warps and JPEGs
constexpr double warping_share = 0.5;
// Moving things in the pictures of visitors who stand get at most this share of the time: the first
// while nobody walks, the second while somebody does.
constexpr double most_moving_share = 0.5, least_moving_share = 0.25;
constexpr float nearly_all = 0.999f;   // share of converged pixels
constexpr double standing_weight = 4;  // weight of the renderer's time, for charge_weight()
constexpr double most_unlike = 3;      // largest ratio by which charge_weight() evens out costs

// Returns the seconds that a picture for each moving visitor takes: a warp takes all cores, its
// JPEG one.
double showing_seconds(const ShowVisits& visits, double time) {
  double milliseconds = 0;
  for (const Visitor& visitor : visits.visitors)
    if (is_shown(visitor) && !stands(time, visitor))
      milliseconds += double(visitor.times.warp) +
                      double(visitor.times.encode) / oneapi::tbb::info::default_concurrency();
  return 0.001 * milliseconds;
}

// Returns the part of state_of() that does not depend on rates.
VisitorDrawState facts_of(const Show& show, const Visitor& visitor) {
  const VisitorPicture& picture = *visitor.picture;
  const VisitorPlace& place = visitor.place;
  VisitorDrawState state;
  state.welcomed = is_shown(visitor);
  state.at_work = picture.at_work;
  state.can_take = may_take(show.time, visitor);
  state.stands = stands(show.time, visitor);
  state.new_place = place.camera_cuts != picture.job.camera_cuts;
  state.same_view = picture.job.view == place.last_view;
  // The renderer brings the picture that it draws to the present light.
  state.other_light =
      show.drawing->renderer.drawn != visitor.link->id &&
      (picture.lamps != visitor.lamps.lit || picture.hour != visitor.lamps.lit_hour ||
       picture.shown_pieces != visitor.pieces.shown || has_new_pieces(picture.pieces) ||
       picture.job.sways != visitor.lawns.sways);
  state.at_once = is_wanted_at_once(picture, place.last_view);
  state.lens_moves = moves_lens(show.time, visitor);
  state.lens_due = lens_is_due(show, visitor);
  state.lens_at = picture.lens.drawn_at;
  state.sees_moving =
      state.welcomed && sees_moving(show.cast, show.visits, visitor, place.last_view);
  state.drew_moving = picture.job.sees_moving;
  state.unshown = picture.unshown;
  state.backdrop = picture.backdrop;
  state.in_pass = show.drawing->pass.visitor == visitor.link->id;
  state.came_at = visitor.came_at;
  state.drawn_at = picture.drawn_at;
  state.posed_at = picture.posed_at;
  state.shown_at = visitor.shown.sent_at;
  state.moved_at = place.moved_at;
  state.asked_seconds = picture.broker_seconds;
  state.served = picture.served;
  state.rest = picture.rest;
  return state;
}

int count_backdrops(const Show& show) {
  auto has = [&](const Visitor& one) { return has_backdrop(facts_of(show, one)); };
  return int(std::count_if(show.visits.visitors.begin(), show.visits.visitors.end(), has));
}

// Returns pictures a second of moving things, for each of the `backdrops` visitors who have one.
double moving_rate(const Show& show, const Visitor& visitor, int backdrops) {
  double seconds = 0.001 * double(visitor.times.moving) * double(std::max(backdrops, 1));
  double rate = picture_rate(show, visitor);
  const double share =
      count_moving(show.visits, show.time) > 0 ? least_moving_share : most_moving_share;
  return seconds > 0 ? std::min(rate, share / seconds) : rate;
}

VisitorDrawState state_of(const Show& show, const Visitor& visitor, int backdrops) {
  VisitorDrawState state = facts_of(show, visitor);
  state.picture_rate = picture_rate(show, visitor);
  state.drawing_rate = drawing_rate(show, visitor);
  state.moving_rate = moving_rate(show, visitor, backdrops);
  return state;
}

}  // namespace

void watch(const Show& show, Visitor& visitor) {
  VisitorPlace& place = visitor.place;
  View view = view_of(show, visitor);
  if (view != place.last_view) {
    place.moved_at = show.time;
    visitor.picture->rest = {};
  }
  const bool leapt = note_view(place.heading, show.time, view);
  if (view != place.last_view) place.leapt = leapt;
  if (leapt) place.camera_cuts++;
  const LitLawns& lawns = show.stage.lawns;
  if (view != place.last_view)
    visitor.lawns.seen = sees_lawns(*show.stage.world, lawns.shown(), view);
  place.last_view = view;
  visitor.dynamic = dynamic_lights_in(view, dynamic_lights_of(show, visitor, show.time));
  visitor.lawns.sways = visitor.lawns.seen && (lawns.moves() || !visitor.dynamic.empty());
}

bool stands(double time, const Visitor& visitor) {
  return visitor.shown.frame_number > 0 && time - visitor.place.moved_at > still_after &&
         visitor.place.velocity == vec3(0) && visitor.place.move == vec3(0);
}

bool rests(const Show& show, const Visitor& visitor) {
  return !asks_for_samples(show, visitor) && !sees_motion(show, visitor, visitor.place.last_view);
}

bool asks_for_samples(const Show& show, const Visitor& visitor) {
  if (!stands(show.time, visitor)) return true;
  return keeps_picture(facts_of(show, visitor)) ? !has_all_samples(visitor.picture->rest)
                                                : visitor.picture->stats.converged < nearly_all;
}

int count_moving(const ShowVisits& visits, double time) {
  auto moves = [&](const Visitor& one) { return is_shown(one) && !stands(time, one); };
  return int(std::count_if(visits.visitors.begin(), visits.visitors.end(), moves));
}

double charge_weight(const ShowVisits& visits, double time, const Visitor& visitor) {
  if (stands(time, visitor)) return standing_weight;
  double sum = 0;
  int count = 0;
  for (const Visitor& one : visits.visitors)
    if (is_shown(one) && !stands(time, one) && one.times.whole > 0)
      sum += double(one.times.whole), count++;
  if (count == 0 || !(visitor.times.whole > 0)) return 1;
  return std::clamp(sum / count / double(visitor.times.whole), 1 / most_unlike, most_unlike);
}

bool may_take(double time, const Visitor& visitor) {
  if (visitor.wall.role == WallRole::camera) return tiles_may_take(visitor, time);
  return is_shown(visitor) && takes_pictures(visitor, time);
}

double picture_rate(const Show& show, const Visitor& visitor) {
  double rate = picture_plan(show.settings, visitor).rate;
  if (stands(show.time, visitor)) {
    rate = std::min(rate, sees_others_move(show, visitor, visitor.place.last_view) ? still_rate
                          : visitor.lawns.sways  ? visitor.wants.local ? moved_rate : swaying_rate
                          : rests(show, visitor) ? resting_rate
                                                 : settling_rate);
  } else {
    // All get the same rate, whosever warps cost most.
    if (double seconds = showing_seconds(show.visits, show.time); seconds > 0)
      rate = std::min(rate, warping_share / seconds);
  }
  if (visitor.kiosk && !show.house.state.open) rate = closed_rate;
  return std::clamp(rate, 1.0, 120.0);
}

namespace {

// Returns the pictures a second whose samples are to find changes of the light: fewer the longer
// none was found, as many in a minute as in the first few seconds.
double watching_rate(double time, const Visitor& visitor) {
  const double since = time - std::max(visitor.place.moved_at, visitor.picture->rest.passed_at);
  return std::clamp(resting_rate * settled_seconds / std::max(since, settled_seconds), rested_rate,
                    resting_rate);
}

}  // namespace

double drawing_rate(const Show& show, const Visitor& visitor) {
  const VisitorPicture& picture = *visitor.picture;
  double rate = picture_rate(show, visitor);
  if (!stands(show.time, visitor))
    return std::min(rate,
                    1 / plan_next_keyframe(show.visits, *show.drawing, show.time, visitor).period);
  if (rests(show, visitor)) rate = std::min(rate, watching_rate(show.time, visitor));
  if (picture.backdrop) rate = std::min(rate, backdrop_rate);
  // Until the first reconstruction, samples do more for it than pictures.
  bool first = show.drawing->pass.denoiser && !picture.rest.reconstructed && !rests(show, visitor);
  first &= picture.backdrop || !picture.job.sees_moving;
  return first ? std::min(rate, picture.backdrop ? learning_backdrop_rate : learning_rate) : rate;
}

double moving_share(const Show& show) {
  const int backdrops = count_backdrops(show);
  double share = 0;
  for (const Visitor& visitor : show.visits.visitors)
    if (has_backdrop(facts_of(show, visitor)))
      share += 0.001 * double(visitor.times.moving) * moving_rate(show, visitor, backdrops);
  return std::min(share, most_moving_share);
}

double seconds_to_moving(const Show& show) {
  const int backdrops = count_backdrops(show);
  double seconds = 1;
  for (const Visitor& visitor : show.visits.visitors)
    if (has_backdrop(facts_of(show, visitor))) {
      double due = visitor.picture->posed_at + 1 / moving_rate(show, visitor, backdrops);
      seconds = std::min(seconds, due - show.time);
    }
  return std::max(seconds, 0.0);
}

DrawingCosts drawing_costs(const ShowVisits& visits, const ShowDrawing& drawing,
                           const Visitor& visitor) {
  const StageTimes& times = visitor.times;
  auto seconds = [](float milliseconds) { return 0.001 * double(milliseconds); };
  DrawingCosts costs{drawing.samples_per_second, seconds(times.drawing),
                     seconds(times.display + times.tonemap), seconds(times.light)};
  // A newcomer's first picture is expected to cost what others' have cost.
  if (visitor.picture->drawn_at < 0 && costs.drawing_seconds == 0)
    costs.drawing_seconds = visits.capacity->standing().cost.drawn *
                            weighed_pixels(double(visitor.wants.width) * visitor.wants.height) /
                            oneapi::tbb::info::default_concurrency();
  return costs;
}

// Returns the ageing that follows from how the visitor moves just now.
static Ageing ageing_of(const Visitor& visitor) {
  const View& now = visitor.place.last_view;
  const EyeMotion motion = motion_of(visitor.place.heading, now);
  const float across = 2 * std::atan(now.tan_half_fov * float(now.width) / float(now.height));
  return {motion.speed * visitor.picture->relief, motion.turn / across};
}

KeyframePlan plan_next_keyframe(const ShowVisits& visits, const ShowDrawing& drawing, double time,
                                const Visitor& visitor) {
  const DrawingCosts costs = drawing_costs(visits, drawing, visitor);
  double light = costs.light_seconds > 0 ? costs.light_seconds : costs.display_seconds;
  return plan_keyframe((costs.drawing_seconds + light) * std::max(count_moving(visits, time), 1),
                       visitor.picture->job.scale,
                       visitor.wants.local ? longest_period(ageing_of(visitor)) : finished_period);
}

std::vector<VisitorDrawState> draw_states(const Show& show) {
  const int backdrops = count_backdrops(show);
  std::vector<VisitorDrawState> states;
  for (const Visitor& visitor : show.visits.visitors)
    states.push_back(state_of(show, visitor, backdrops));
  return states;
}

RendererState renderer_state(const Show& show) {
  const Renderer& renderer = show.drawing->renderer;
  RendererState state;
  state.idle = renderer.idle();
  int index = 0;
  for (const Visitor& visitor : show.visits.visitors) {
    if (visitor.link->id == renderer.drawn) state.drawn = index;
    index++;
  }
  state.traces = renderer.step == DrawingStep::trace;
  state.can_reconstruct = show.drawing->pass.denoiser != nullptr;
  state.in_pass = show.drawing->pass.visitor != 0;
  state.has_skin = !show.stage.skin.places.empty();
  state.skin_at = renderer.skin.time;
  state.skin_interval = renderer.skin.interval;
  state.skin_turn = renderer.skin.turn;
  state.served = renderer.served;
  return state;
}

}  // namespace wellspring::show
