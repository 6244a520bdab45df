// SPDX-License-Identifier: Apache-2.0
#include "show/state/animations.h"

#include <algorithm>

#include "show/state/in_view.h"

namespace wellspring::show {

namespace {

using Start = ExhibitAnimation::Start;

const Play& play_of(const Show& show, const Visitor& visitor, size_t i) {
  const Visitor* own = show.exhibit.animations[i].shared ? nullptr : who_touched(show, visitor);
  return own ? own->plays[i] : show.plays[i];
}

bool in_reach(const View& view, const Reach& reach) {
  return reach.radius > 0 && in_view(view, reach.centre, reach.radius);
}

void set_animation(Show& show, Visitor& visitor, size_t i, bool on) {
  const ExhibitAnimation& animation = show.exhibit.animations[i];
  if (!animation.shared && visitor.plays.empty()) visitor.plays.resize(show.plays.size());
  Play& play = animation.shared ? show.plays[i] : visitor.plays[i];
  set_on(animation, on, show.time, play);
  visitor.state_sent_at = -1e9;
  if (!animation.shared) return;
  for (Visitor& other : show.visitors) other.state_sent_at = -1e9;
}

}  // namespace

const Visitor* who_touched(const Show& show, const Visitor& visitor) {
  const Visitor* leader = leader_of(show, visitor);
  const Visitor& who = leader ? *leader : visitor;
  return who.plays.empty() ? nullptr : &who;
}

std::vector<double> animation_times(const Show& show, const Visitor& visitor) {
  std::vector<double> times;
  for (size_t i = 0; i < show.exhibit.animations.size(); i++)
    times.push_back(time_of(show.exhibit.animations[i], play_of(show, visitor, i), show.time));
  return times;
}

bool is_on(const Show& show, const Visitor& visitor, size_t animation) {
  return play_of(show, visitor, animation).on;
}

bool sees_moving(const Show& show, const Visitor& visitor, const View& view) {
  return !visitor.dynamic.empty() || sees_figure(show, teller_of(show, visitor), view) ||
         std::ranges::any_of(show.movers.reach,
                             [&](const Reach& reach) { return in_reach(view, reach); });
}

bool sees_motion(const Show& show, const Visitor& visitor, const View& view) {
  if (!visitor.dynamic.empty() || sees_figure(show, teller_of(show, visitor), view)) return true;
  for (size_t i = 0; i < show.exhibit.animations.size(); i++)
    if (in_reach(view, show.movers.reach[i]) &&
        is_running(show.exhibit.animations[i], play_of(show, visitor, i), show.time))
      return true;
  return false;
}

bool play_animation(Show& show, Visitor& visitor, std::string_view id, bool on) {
  const std::vector<ExhibitAnimation>& all = show.exhibit.animations;
  const auto found = std::ranges::find(all, id, &ExhibitAnimation::id);
  if (found == all.end() || found->start != Start::touch) return false;
  set_animation(show, visitor, size_t(found - all.begin()), on);
  return true;
}

void touch_object(Show& show, Visitor& visitor, int point) {
  for (size_t i = 0; i < show.exhibit.animations.size(); i++) {
    const ExhibitAnimation& animation = show.exhibit.animations[i];
    if (animation.start == Start::touch && animation.point == point)
      set_animation(show, visitor, i, !is_on(show, visitor, i));
  }
}

}  // namespace wellspring::show
