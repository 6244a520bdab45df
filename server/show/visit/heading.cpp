// SPDX-License-Identifier: Apache-2.0
#include "show/visit/heading.h"

#include <algorithm>
#include <cmath>

#include "cache/predict.h"
#include "picture/keyframe.h"

namespace wellspring::show {
namespace {

constexpr double motion_seconds =
    0.05;  // in which motion is measured: inputs may come thirty times a second
constexpr double longest_gap = 0.5;   // between two views that tell motion
constexpr size_t most_past = 32;      // views of that time
constexpr float fastest = 25;         // metres a second; more is a jump
constexpr float smallest_cut = 0.5f;  // metres

constexpr float widest_turn = 0.8f;     // radians to either side
constexpr float turned_away = 0.8f;     // radians
constexpr float walked_away = 2;        // metres
constexpr float wide_share = 1 / 8.0f;  // of the view's pixels

}  // namespace

bool note_view(Heading& heading, double time, const View& view) {
  std::vector<Heading::PastView>& past = heading.past;
  bool cut = false;
  if (!past.empty()) {
    float passed = float(time - past.back().time);
    cut = length(view.position - past.back().view.position) > fastest * passed + smallest_cut;
  }
  auto alike = [&](const Heading::PastView& one) {
    return !cut && time - one.time <= longest_gap && one.view.width == view.width &&
           one.view.height == view.height;
  };
  auto of_use = [&](const Heading::PastView& one) {
    return alike(one) && time - one.time <= motion_seconds;
  };
  auto first = std::find_if(past.begin(), past.end(), of_use);
  // Where ticks come late the last one has to do, or there would be no motion.
  if (first == past.end() && !past.empty() && alike(past.back())) first--;
  past.erase(past.begin(), first);
  if (past.size() >= most_past) past.erase(past.begin());
  past.push_back({time, view});
  return cut;
}

View expected_view(const Heading& heading, const View& now, double seconds) {
  // Of a quick turn less than all views are enough.
  for (const Heading::PastView& past : heading.past) {
    double passed = heading.past.back().time - past.time;
    if (!(passed > 0)) break;
    View ahead = extrapolate(past.view, now, float(seconds / passed));
    if (ahead != now) return ahead;
  }
  return now;
}

float expected_turn(const Heading& heading, const View& now, double seconds) {
  return std::acos(
      std::clamp(dot(now.forward, expected_view(heading, now, seconds).forward), -1.0f, 1.0f));
}

EyeMotion motion_of(const Heading& heading, const View& now) {
  constexpr float seconds = 0.1f;
  const View ahead = expected_view(heading, now, seconds);
  return {length(ahead.position - now.position) / seconds,
          expected_turn(heading, now, seconds) / seconds};
}

View wide_view(const View& now) {
  View left = now, right = now;
  for (auto [view, turn] : {std::pair(&left, widest_turn), {&right, -widest_turn}}) {
    view->forward = std::cos(turn) * now.forward - std::sin(turn) * now.right;
    view->right = std::cos(turn) * now.right + std::sin(turn) * now.forward;
  }
  const View views[] = {now, left, right};
  return surrounding_view(views, wide_share);
}

bool is_elsewhere(const View& wide, const View& now) {
  return dot(wide.forward, now.forward) < std::cos(turned_away) ||
         length(wide.position - now.position) > walked_away;
}

}  // namespace wellspring::show
