// SPDX-License-Identifier: Apache-2.0
#include "show/state/visitor_world.h"

#include <algorithm>
#include <utility>

#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"

namespace wellspring::show {
namespace {

uint64_t number_who_touched(const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* who = who_touched(visits, visitor);
  return who ? who->link->id : 0;
}

uint64_t number_who_holds(const Visitor& visitor) {
  return visitor.held.size > 0 ? visitor.link->id : 0;
}

// Places what the guest of a kiosk's page holds up before that page's camera.
ShownHeld held_before(const Show& show, const Visitor& visitor) {
  const Kiosk* kiosk = kiosk_of(show, visitor);
  if (!kiosk || visitor.held.size <= 0) return {};
  const View view = rest_view(show.stage, visitor);
  const float away = rest_distance(kiosk->settings.screen, view);
  return {visitor.held.model, {place_held(visitor.held, view, away), visitor.held.size, 1}};
}

// Returns what the visitor sees of pieces by now: on the way to the wish, after a story's mark.
PieceChoices pieces_now(const Show& show, const Visitor& visitor) {
  const Visitor* leader = leader_of(show.visits, visitor);
  const VisitorPieces& pieces = (leader ? *leader : visitor).pieces;
  const double done = (show.time - pieces.told_at) / glide_seconds;
  if (!(done < 1)) return pieces.wish;
  return glide(pieces.before, pieces.wish, float(glm::smoothstep(0.0, 1.0, done)));
}

constexpr float foot_radius = 0.2f, hip_height = 0.9f;  // metres
constexpr float longest_step = 1.5f;  // metres between two looks; who has come farther has leapt

// Adds a leg that stands on the ground at `ground`.
void add_leg(vec3 ground, Walkers& walkers) {
  walkers.capsules.push_back(
      {ground + vec3(0, foot_radius, 0), ground + vec3(0, hip_height, 0), foot_radius});
}

// Returns who walks: storytellers that are to be seen, and visitors, with the way that these have
// come since the last step.
Walkers find_walkers(Show& show) {
  Walkers walkers;
  for (const Teller* teller : tellers_of(show.cast, show.visits))
    if (teller->visible && !show.cast.figures.empty())
      add_leg(vec3(teller->storyteller.placement[3]), walkers);
  const std::optional<WalkSettings>& walk = show.stage.exhibit.walk;
  for (Visitor& visitor : show.visits.visitors) {
    if (!walk || !is_shown(visitor) || visitor.kiosk) continue;
    const vec3 ground = visitor.place.last_view.position - vec3(0, walk->eye_height, 0),
               ankle = ground + vec3(0, foot_radius, 0);
    add_leg(ground, walkers);
    const std::optional<vec3> before = std::exchange(visitor.lawns.ankle, ankle);
    if (before && glm::length(ankle - *before) < longest_step)
      walkers.capsules.push_back({*before, ankle, foot_radius});
  }
  return walkers;
}

// Lets time pass for lawns, while anybody sees one.
void step_lawns(Show& show) {
  auto sees = [](const Visitor& visitor) { return is_shown(visitor) && visitor.lawns.seen; };
  if (std::ranges::any_of(show.visits.visitors, sees))
    show.stage.lawns.step(show.time, find_walkers(show));
}

void light_lawns(Show& show, const Visitor& visitor) {
  if (!visitor.lawns.seen) return;
  std::vector<PunctualLight> sun;
  for (const DynamicLight& one : dynamic_lights_of(show, visitor, show.time))
    if (one.id == sun_of_the_day) sun.push_back(one.light);
  show.stage.lawns.light(*show.stage.world, show.stage.lights, *show.stage.technique, sun,
                         visitor.lamps.lit_hour);
}

}  // namespace

void pose_world(ExhibitStage& stage, ShowCast& cast, double time, const Teller& teller,
                const std::vector<double>& times, const ShownHeld& held) {
  cast.posed_by = {
      time,        teller.index, teller.visible, teller.pose, teller.storyteller.placement,
      teller.held, times,        held.model,     held.pose};
  bool moved = pose_movers(stage.exhibit, times, cast.movers, *stage.world);
  cast.posed_as = teller.number;
  for (size_t i = 0; i < cast.figures.size(); i++)
    show_figure(*stage.world, cast.figures[i], i == teller.index && teller.visible);
  for (size_t i = 0; i < cast.props.size(); i++)
    moved |=
        pose_prop(*stage.world, cast.props[i], pose_of(stage.exhibit, teller.held, int(i), time));
  for (size_t i = 0; i < cast.held.size(); i++)
    moved |=
        pose_prop(*stage.world, cast.held[i].second, int(i) == held.model ? held.pose : PropPose{});
  if (cast.figures.empty() && !moved) return;
  if (teller.visible && !cast.figures.empty())
    pose_figure(*stage.world, cast.figures[teller.index],
                storyteller_of(stage, cast, teller)->character, teller.pose,
                teller.storyteller.placement, cast.scratch);
  stage.world->commit();
  cast.pose_number++;
}

const PieceChoices& pieces_of(const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* leader = leader_of(visits, visitor);
  return (leader ? *leader : visitor).pieces.wish;
}

void see_told(const Exhibit& exhibit, double time, const std::string& piece, const PieceMark& mark,
              Visitor& visitor) {
  VisitorPieces& pieces = visitor.pieces;
  if (!choose_told(exhibit, piece, mark, pieces.wish).empty()) return;
  pieces.before = pieces.shown.choices, pieces.told_at = time;
  visitor.state_sent_at = -1e9;
}

void follow_wish(const Show& show, Visitor& visitor) {
  const Exhibit& exhibit = show.stage.exhibit;
  ShownPieces wish{pieces_now(show, visitor), piece_language(exhibit, visitor.lang)};
  VisitorPieces& pieces = visitor.pieces;
  const uint64_t arrivals = show.stage.volumes.arrivals();
  if (pieces.shown == wish && pieces.arrivals == arrivals) return;
  // A volume that is turned or cut is something that moves.
  if (changes_volume(exhibit, pieces.shown.choices, wish.choices))
    visitor.place.moved_at = show.time;
  pieces.shown = std::move(wish), pieces.arrivals = arrivals;
  visitor.picture->around = {}, visitor.picture->fade = {};  // both show something else
  look_anew(*visitor.picture);
}

void show_pieces_of(ExhibitStage& stage, const ShownPieces& shown) {
  show_pieces(stage.exhibit, shown, *stage.world);
  stage.volumes.show(stage.exhibit, shown.choices, stage.lights, *stage.technique, *stage.world);
}

void begin_world_of(Show& show, Visitor& visitor) {
  light_world(show.stage, visitor.lamps.lit);
  show_pieces_of(show.stage, visitor.pieces.shown);
  pose_world(show.stage, show.cast, show.time, teller_of(show.cast, show.visits, visitor),
             animation_times(show, visitor), held_before(show, visitor));
  step_lawns(show);
  light_lawns(show, visitor);
  show.cast.posed_for = number_who_touched(show.visits, visitor);
  show.cast.posed_held = number_who_holds(visitor);
}

void go_on_in_world_of(Show& show, Visitor& visitor) {
  light_world(show.stage, visitor.lamps.lit);
  show_pieces_of(show.stage, visitor.pieces.shown);
  if (show.cast.posed_as == teller_of(show.cast, show.visits, visitor).number &&
      show.cast.posed_for == number_who_touched(show.visits, visitor) &&
      show.cast.posed_held == number_who_holds(visitor))
    return light_lawns(show, visitor);
  begin_world_of(show, visitor);
}

bool see_the_same(const ShowCast& cast, const ShowVisits& visits, const Visitor& a,
                  const Visitor& b) {
  return &teller_of(cast, visits, a) == &teller_of(cast, visits, b) && a.lamps.lit == b.lamps.lit &&
         a.lamps.lit_hour == b.lamps.lit_hour && a.pieces.shown == b.pieces.shown &&
         who_touched(visits, a) == who_touched(visits, b) &&
         number_who_holds(a) == number_who_holds(b);
}

}  // namespace wellspring::show
