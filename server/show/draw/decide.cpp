// SPDX-License-Identifier: Apache-2.0
#include "show/draw/decide.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace wellspring::show {
namespace {

constexpr double unmeasured_light = 0.4;  // share of the display's time, for moving visitors
constexpr double least_light = 0.25;      // share of the time that goes to light, whatever is drawn
constexpr double least_samples = 1000;    // samples of a picture, however slow the machine
constexpr double most_a_pixel = 0.5;
constexpr double aimed_share = 0.0625;  // share of the samples at rest
constexpr float nearly_none = 0.1f;     // share of the picture's pixels
constexpr float most_known = 0.5f;      // likewise
constexpr double settled_after = 2;     // seconds
constexpr float keyframe_scales[] = {1, 0.75f, 0.5f, 0.375f};
constexpr double shortest_period = 1 / 30.0;  // seconds from keyframe to keyframe
// FLIP, in the mean of the picture: what a keyframe's age may add, and what a picture adds that is
// wrong all over (cache.warp, stroll and orbit at 300 ms) or as soft as the wide keyframe.
constexpr float borne = 0.0135f, of_uncovered = 0.45f, of_turned_to = 0.1f;
constexpr double least_local_period = 1 / 10.0, most_local_period = 1 / 3.0;
constexpr double sample_share = 0.3;  // share of that time, at least
// share of the time allowed, at which a larger keyframe is drawn again
constexpr double climbing = 0.7;
constexpr float most_uncovered = 0.2f;  // share of a picture's width that a tour's turn may uncover

}  // namespace

int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool stands) {
  double display = costs.display_seconds;
  if (!stands) display = costs.light_seconds > 0 ? costs.light_seconds : unmeasured_light * display;
  double tracing = std::max(seconds + costs.display_seconds - display - costs.drawing_seconds,
                            least_light * seconds);
  // Visitors who stand gain by light what fewer pictures cost; those who move, by pictures.
  if (stands)
    tracing =
        std::max(tracing, least_light / (1 - least_light) * (display + costs.drawing_seconds));
  double samples =
      std::clamp(tracing * costs.samples_per_second, 0.0, most_a_pixel * double(pixels));
  return int(std::max(samples, std::min(least_samples, double(pixels))));
}

int samples_to_watch(int samples) { return int(aimed_share * samples); }

double keyframe_cost(float scale) { return double(scale); }

double longest_period(const Ageing& ageing) {
  const float error = of_uncovered * ageing.uncovered + of_turned_to * ageing.turned_to;
  if (!(error > 0)) return most_local_period;  // nothing ages, or it is not measured
  return std::clamp(double(borne / error), least_local_period, most_local_period);
}

KeyframePlan plan_keyframe(double seconds, float before, double longest_period) {
  const double most = (1 - sample_share) * longest_period;
  auto cost = [&](float scale) { return seconds * keyframe_cost(scale) / keyframe_cost(before); };
  auto fits = [&](float scale) { return cost(scale) <= (scale > before ? climbing * most : most); };
  const float* found = std::find_if(std::begin(keyframe_scales), std::end(keyframe_scales), fits);
  float scale = found == std::end(keyframe_scales) ? *std::prev(found) : *found;
  return {scale, std::clamp(cost(scale) / (1 - sample_share), shortest_period, longest_period)};
}

float tour_pace(float turn, float fov) {
  float most = most_uncovered * fov;
  return turn > most ? most / turn : 1.0f;
}

bool wants_reference(double seconds_at_rest, bool before, float guessed, float known) {
  if (seconds_at_rest <= settled_after) return false;
  return before || (guessed <= nearly_none && known >= most_known);
}

namespace {

constexpr double on_time = 0.0005;   // seconds that a picture may come too early
constexpr double longest_gap = 0.5;  // seconds without a picture until a walker comes first
// These decide about reconstructions.
constexpr double first_after = 0.5;     // seconds at rest
constexpr double least_a_pixel = 0.25;  // samples a pixel: from fewer it makes no better picture
constexpr double growth = 1.4;          // times as many samples as in the pass before
constexpr double most_share = 0.35;     // share of the time that goes to passes

bool is_busy(int index, const VisitorDrawState& state, const RendererState& renderer) {
  return state.at_work && index != renderer.drawn;
}

// Returns who has waited longest of those whom `wants` names; -1: nobody.
template <class Wants, class Since>
int longest_waiting(std::span<const VisitorDrawState> states, const Wants& wants,
                    const Since& since) {
  int next = -1;
  for (int i = 0; i < int(states.size()); i++)
    if (wants(i) && (next < 0 || since(states[size_t(i)]) < since(states[size_t(next)]))) next = i;
  return next;
}

int next_to_pose(double now, std::span<const VisitorDrawState> states,
                 const RendererState& renderer) {
  auto wants = [&](int i) {
    const VisitorDrawState& state = states[size_t(i)];
    return !is_busy(i, state, renderer) && wants_moving(now, state);
  };
  return longest_waiting(states, wants, [](const VisitorDrawState& one) { return one.posed_at; });
}

// Holds whose picture is drawn next, -1: nobody's, and the least renderer's time that any of those
// has had who want a picture.
struct NextPicture {
  int visitor = -1;
  double served = 0;
};

// Finds whose picture is drawn next. While others wait, visitors whose picture stays do without
// more samples.
NextPicture next_to_draw(double now, std::span<const VisitorDrawState> states,
                         const RendererState& renderer) {
  auto wants = [&](int i) {
    const VisitorDrawState& state = states[size_t(i)];
    return wants_picture(now, state) && (renderer.waiting == 0 || !keeps_picture(state));
  };
  auto served = [&](const VisitorDrawState& one) { return std::max(one.served, renderer.served); };
  // Newcomers wait since they came: they do not all come before those who are there.
  auto since = [&](const VisitorDrawState& one) {
    return std::pair(served(one), std::max(one.drawn_at, one.came_at));
  };
  // A visitor whose last keyframe was of no use, since it was drawn for another view, has waited as
  // well.
  auto without = [](const VisitorDrawState& one) { return std::max(one.shown_at, one.came_at); };
  auto too_long = [&](int i) {
    const VisitorDrawState& state = states[size_t(i)];
    return wants(i) && !state.stands && now - without(state) > longest_gap;
  };
  const int least = longest_waiting(states, wants, since);
  if (least < 0) return {};
  const int first = longest_waiting(states, too_long, [&](const VisitorDrawState& one) {
    return std::max(without(one), one.drawn_at);
  });
  return {first < 0 ? least : first, served(states[size_t(least)])};
}

PictureKind kind_of(double now, const VisitorDrawState& state, const RendererState& renderer) {
  if (wants_pass(now, state, renderer)) return PictureKind::reconstruction;
  if (renderer.can_reconstruct && keeps_picture(state)) return PictureKind::samples;
  return state.stands ? PictureKind::still : PictureKind::moving;
}

// Returns who is due to have a glass drawn, whoever has waited longest; -1: nobody.
int next_lens(std::span<const VisitorDrawState> states) {
  int next = -1;
  for (size_t i = 0; i < states.size(); i++) {
    const VisitorDrawState& one = states[i];
    if (!one.welcomed || one.at_work || !one.lens_due) continue;
    if (next < 0 || one.lens_at < states[size_t(next)].lens_at) next = int(i);
  }
  return next;
}

}  // namespace

bool has_backdrop(const VisitorDrawState& state) {
  return state.welcomed && state.backdrop && !state.new_place && state.same_view && state.stands;
}

bool wants_moving(double now, const VisitorDrawState& state) {
  if (!has_backdrop(state) || state.unshown || !state.can_take) return false;
  return now - state.posed_at >= 1 / state.moving_rate - on_time;
}

int next_to_light(double now, std::span<const VisitorDrawState> states,
                  const RendererState& renderer) {
  if (!renderer.has_skin || now - renderer.skin_at < renderer.skin_interval - on_time) return -1;
  auto sees = [](const VisitorDrawState& one) { return one.welcomed && one.sees_moving; };
  const auto count = std::count_if(states.begin(), states.end(), sees);
  if (count == 0) return -1;
  uint64_t left = renderer.skin_turn % uint64_t(count);
  for (size_t i = 0;; i++)
    if (sees(states[i]) && left-- == 0) return int(i);
}

bool wants_picture(double now, const VisitorDrawState& state) {
  if (!state.welcomed || state.at_work || !state.can_take) return false;
  if (state.new_place) return true;
  const bool walks = !state.stands;
  if ((state.unshown || state.in_pass) && !walks) return false;
  // The light changed, or the storyteller came or went: a visitor at rest sees it at once.
  bool changed = state.other_light || state.at_once || state.drew_moving != state.sees_moving;
  if (!walks && changed) return true;
  // A better picture may come when the glass stands.
  if (!walks && state.lens_moves && state.same_view) return false;
  double rate = walks ? state.picture_rate : state.drawing_rate;
  return now - state.drawn_at >= 1 / rate - on_time;
}

bool keeps_picture(const VisitorDrawState& state) {
  return state.rest.reconstructed && state.stands && state.same_view && !state.new_place &&
         !state.other_light;
}

bool wants_pass(double now, const VisitorDrawState& state, const RendererState& renderer) {
  const RestState& rest = state.rest;
  if (!renderer.can_reconstruct || renderer.in_pass) return false;
  if (!state.stands || now - state.moved_at < first_after || rest.samples < least_a_pixel)
    return false;
  // A reconstruction does not show moving things.
  if (state.drew_moving && !state.backdrop) return false;
  if (!rest.reconstructed) return true;
  double pause = rest.passed_seconds * (1 / most_share - 1);
  bool enough = rest.samples >= growth * rest.passed_samples ||
                (has_all_samples(rest) && rest.passed_samples < most_rest_samples);
  return enough && now - rest.passed_at >= pause;
}

Demand find_demand(double now, std::span<const VisitorDrawState> states,
                   const RendererState& renderer) {
  if (!renderer.idle) return {};
  auto waits = [&](const VisitorDrawState& state) {
    return wants_picture(now, state) && !keeps_picture(state);
  };
  return {int(std::count_if(states.begin(), states.end(), waits)),
          next_to_pose(now, states, renderer) >= 0};
}

Decision decide(double now, std::span<const VisitorDrawState> states,
                const RendererState& renderer) {
  if (!renderer.idle) return {};
  if (int next = next_to_pose(now, states, renderer); next >= 0) return {Drawing::moving, next};
  if (int next = next_to_light(now, states, renderer); next >= 0) return {Drawing::skin, next};
  if (renderer.drawn >= 0)
    return {Drawing::go_on, renderer.drawn, renderer.traces && renderer.waiting > 0};
  if (int next = next_lens(states); next >= 0) return {Drawing::lens, next};
  auto asks = [](const VisitorDrawState& one) { return one.asked_seconds > 0; };
  if (std::any_of(states.begin(), states.end(), asks)) return {Drawing::samples};
  if (renderer.in_pass && renderer.waiting == 0) return {Drawing::pass};
  const NextPicture next = next_to_draw(now, states, renderer);
  if (next.visitor < 0) return {};
  const PictureKind kind = kind_of(now, states[size_t(next.visitor)], renderer);
  return {Drawing::picture, next.visitor, false, kind, next.served};
}

}  // namespace wellspring::show
