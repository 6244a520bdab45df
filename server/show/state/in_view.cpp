// SPDX-License-Identifier: Apache-2.0
#include "show/state/in_view.h"

#include <algorithm>
#include <cmath>

#include "show/kiosk/kiosk.h"

namespace wellspring::show {

namespace {

constexpr float head_height = 1.5f, head_reach = 0.45f;  // metres; bowing and leaning included
constexpr float body_height = 0.9f, body_reach = 1.3f;
constexpr float nobody_near = 1e6f;

vec3 above_feet(const Teller& teller, float height) {
  return vec3(teller.storyteller.placement * vec4(0, height, 0, 1));
}

// Returns metres to the storyteller's head if the visitor may see it, else nobody_near.
float distance_to_head(const Show& show, const Visitor& visitor, const Teller& teller) {
  if (!visitor.welcomed || &teller_of(show.cast, show.visits, visitor) != &teller)
    return nobody_near;
  View view = view_of(show, visitor);
  if (!sees_head(show.cast, teller, view)) return nobody_near;
  const vec3 head = above_feet(teller, head_height);
  const Kiosk* kiosk = kiosk_of(show, visitor);
  if (!kiosk || kiosk->audience.guests.empty()) return glm::length(view.position - head);
  // The screen is a window: guests who stand before it see the storyteller from there.
  float nearest = nobody_near;
  for (const Guest& guest : kiosk->audience.guests)
    nearest = std::min(nearest, glm::length(guest.head - head));
  return nearest;
}

}  // namespace

bool in_view(const View& view, vec3 centre, float radius) {
  vec3 d = centre - view.position;
  float depth = dot(d, view.forward);
  if (depth < -radius) return false;
  float aspect = float(view.width) / float(view.height);
  float slope = view.tan_half_fov * std::sqrt(1 + aspect * aspect) + glm::length(view.middle);
  return glm::length(d - view.forward * depth) <
         slope * std::max(depth, 0.0f) + radius * std::sqrt(1 + slope * slope);
}

View rest_view(const ExhibitStage& stage, const Visitor& visitor) {
  const Around& around = visitor.place.around;
  Viewpoint at = around.point >= 0 ? around.view : visitor.place.view;
  if (visitor.wall.role == WallRole::camera)
    at.fov = wall_fov(visitor.wall.part, {visitor.wants.width, visitor.wants.height}, at.fov);
  View view = make_view(stage.exhibit.scene, at, visitor.wants.width, visitor.wants.height);
  view.near = around.near;
  return view;
}

View view_of(const Show& show, const Visitor& visitor) {
  const View rest = rest_view(show.stage, visitor);
  const Kiosk* kiosk = kiosk_of(show, visitor);
  return kiosk ? through_window(rest, kiosk->settings.screen, visitor.window.place) : rest;
}

bool sees_head(const ShowCast& cast, const Teller& teller, const View& view) {
  return !cast.figures.empty() && teller.visible &&
         in_view(view, above_feet(teller, head_height), head_reach);
}

bool sees_figure(const ShowCast& cast, const Teller& teller, const View& view) {
  return !cast.figures.empty() && teller.visible &&
         in_view(view, above_feet(teller, body_height), body_reach);
}

const Visitor* heard_on_tour(const Show& show, const Teller& teller) {
  const Visitor* nearest = nullptr;
  float least = nobody_near;
  for (const Visitor& visitor : show.visits.visitors) {
    const Voice& voice = visitor.hearing.narration.voice;
    if (voice.queue.empty() || voice.paused) continue;
    if (float distance = distance_to_head(show, visitor, teller); distance < least)
      least = distance, nearest = &visitor;
  }
  return nearest;
}

const PointOfInterest* looked_at_beside_her(const Show& show, const Teller& teller) {
  for (const Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && visitor.place.closer >= 0 && listens_to(show, visitor, teller) &&
        sees_head(show.cast, teller, view_of(show, visitor)))
      return &show.stage.exhibit.points[size_t(visitor.place.closer)];
  return nullptr;
}

float viewer_distance(const Show& show, const Teller& teller) {
  float nearest = nobody_near;
  for (const Visitor& visitor : show.visits.visitors)
    nearest = std::min(nearest, distance_to_head(show, visitor, teller));
  return nearest;
}

namespace {

using Start = ExhibitAnimation::Start;

const Play& play_of(const Show& show, const Visitor& visitor, size_t i) {
  const Visitor* own =
      show.stage.exhibit.animations[i].shared ? nullptr : who_touched(show.visits, visitor);
  return own ? own->plays[i] : show.cast.plays[i];
}

bool in_reach(const View& view, const Reach& reach) {
  return reach.radius > 0 && in_view(view, reach.centre, reach.radius);
}

void set_animation(Show& show, Visitor& visitor, size_t i, bool on) {
  const ExhibitAnimation& animation = show.stage.exhibit.animations[i];
  if (!animation.shared && visitor.plays.empty()) visitor.plays.resize(show.cast.plays.size());
  Play& play = animation.shared ? show.cast.plays[i] : visitor.plays[i];
  set_on(animation, on, show.time, play);
  visitor.state_sent_at = -1e9;
  if (!animation.shared) return;
  for (Visitor& other : show.visits.visitors) other.state_sent_at = -1e9;
}

}  // namespace

const Visitor* who_touched(const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* leader = leader_of(visits, visitor);
  const Visitor& who = leader ? *leader : visitor;
  return who.plays.empty() ? nullptr : &who;
}

std::vector<double> animation_times(const Show& show, const Visitor& visitor) {
  std::vector<double> times;
  for (size_t i = 0; i < show.stage.exhibit.animations.size(); i++)
    times.push_back(
        time_of(show.stage.exhibit.animations[i], play_of(show, visitor, i), show.time));
  return times;
}

bool is_on(const Show& show, const Visitor& visitor, size_t animation) {
  return play_of(show, visitor, animation).on;
}

bool sees_moving(const ShowCast& cast, const ShowVisits& visits, const Visitor& visitor,
                 const View& view) {
  return !visitor.dynamic.empty() || visitor.lawns.sways || visitor.held.size > 0 ||
         sees_figure(cast, teller_of(cast, visits, visitor), view) ||
         std::ranges::any_of(cast.movers.reach,
                             [&](const Reach& reach) { return in_reach(view, reach); });
}

bool sees_others_move(const Show& show, const Visitor& visitor, const View& view) {
  if (!visitor.dynamic.empty() || visitor.held.size > 0 ||
      sees_figure(show.cast, teller_of(show.cast, show.visits, visitor), view))
    return true;
  for (size_t i = 0; i < show.stage.exhibit.animations.size(); i++)
    if (in_reach(view, show.cast.movers.reach[i]) &&
        is_running(show.stage.exhibit.animations[i], play_of(show, visitor, i), show.time))
      return true;
  return false;
}

bool sees_motion(const Show& show, const Visitor& visitor, const View& view) {
  return visitor.lawns.sways || sees_others_move(show, visitor, view);
}

bool play_animation(Show& show, Visitor& visitor, std::string_view id, bool on) {
  const std::vector<ExhibitAnimation>& all = show.stage.exhibit.animations;
  const auto found = std::ranges::find(all, id, &ExhibitAnimation::id);
  if (found == all.end() || found->start != Start::touch) return false;
  set_animation(show, visitor, size_t(found - all.begin()), on);
  return true;
}

void touch_object(Show& show, Visitor& visitor, int point) {
  for (size_t i = 0; i < show.stage.exhibit.animations.size(); i++) {
    const ExhibitAnimation& animation = show.stage.exhibit.animations[i];
    if (animation.start == Start::touch && animation.point == point)
      set_animation(show, visitor, i, !is_on(show, visitor, i));
  }
}

}  // namespace wellspring::show
