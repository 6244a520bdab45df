// SPDX-License-Identifier: Apache-2.0
#include "show/tick.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "base/clock.h"
#include "base/log.h"
#include "show/answer/cameras.h"
#include "show/answer/come_back.h"
#include "show/answer/events.h"
#include "show/answer/groups.h"
#include "show/answer/idle.h"
#include "show/answer/orders.h"
#include "show/answer/sound.h"
#include "show/answer/walls.h"
#include "show/count/count.h"
#include "show/draw/carry_out.h"
#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/draw/present.h"
#include "show/draw/steer.h"
#include "show/draw/still_pass.h"
#include "show/state/visitor_world.h"
#include "show/workers/send.h"
#include "show/state/renderer.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/make_show.h"
#include "show/state/visitor_picture.h"
#include "show/storyteller/held_prop.h"
#include "wire/json.h"

namespace wellspring::show {

namespace {

constexpr double agent_interval = 0.1;  // seconds between agent messages while somebody listens
constexpr double state_interval = 0.5;
constexpr double pose_interval = 1 / 30.0;  // seconds between pose messages while the view changes
// seconds while there is sound to be heard from somewhere
constexpr double heard_state_interval = 0.1;
constexpr double behave_interval = 0.04;
constexpr double idle_before_bake = 5;  // seconds in which nothing was drawn
constexpr double looks_every = 0.5;     // seconds between the rays that the baker is given
// seconds that better light waits at most, while visitors walk
constexpr double most_light_waits = 60;
constexpr double least_wait = 0.002;  // seconds between ticks at least, whatever is due
// seconds between looks at what visitors want, pictures or not
constexpr double listening_interval = 0.01;

}  // namespace

bool draws(const ShowVisits& visits, const ShowDrawing& drawing, double time) {
  return !visits.visitors.empty() && time - drawing.drew_at <= idle_before_bake;
}

namespace {

void welcome_links(Show& show, Arrivals& arrivals) {
  for (Arrival& one : arrivals.take()) {
    if (one.link->kind == LinkKind::eye) {
      welcome_camera(show.kiosks, show.time, std::move(one.link));
      continue;
    }
    log::info("visitor {} connected from {}", one.link->id, one.link->peer);
    begin_visit(show, std::move(one.link)).seat = std::move(one.seat);
  }
}

void read_visitors(Show& show, double dt) {
  for (Visitor& visitor : show.visits.visitors) {
    note_deliveries(show, visitor);
    follow_orders(show, visitor);
  }
  for (auto next = show.visits.visitors.begin(); next != show.visits.visitors.end();) {
    auto visitor = next++;
    if (!visitor->left && !visitor->link->closed()) continue;
    visitor->left = true;
    visitor->welcomed = false;
    visitor->link->close("bye");
    bool in_pass = show.drawing->pass.visitor == visitor->link->id;
    if (in_pass) show.drawing->pass.given_up = true;
    if (visitor->picture->at_work || in_pass) continue;  // its work ends soon
    log::info("visitor {} left", visitor->link->id);
    keep_visit(show, visitor);
  }
  watch_presence(show, dt);
  forget_visits(show);
  forget_absent_listeners(show);
  follow_walls(show);
}

void show_subtitle(const Show& show, Visitor& visitor, const Utterance* utterance,
                   bool storyteller) {
  const Exhibit& exhibit = show.stage.exhibit;
  const StorytellerPlace* storyteller_place =
      storyteller_of(show.stage, show.cast, teller_of(show.cast, show.visits, visitor));
  std::string text, speaker;
  if (const auto* line =
          utterance ? line_in(utterance->line, visitor.lang, exhibit.languages) : nullptr)
    text = line->second.text;
  if (storyteller_place && storyteller)
    speaker = text_in(storyteller_place->name, visitor.lang, exhibit.languages);
  visitor.link->send_text(
      subtitle_message(text, visitor.lang, speaker, utterance ? utterance->seconds : 0));
}

// Returns whether the visitor hears the narrator of a tour of their own, or of their leader's.
bool is_narrated(const ShowVisits& visits, const Visitor& visitor) {
  const Visitor* leader = leader_of(visits, visitor);
  const Voice& voice = (leader ? *leader : visitor).hearing.narration.voice;
  return !voice.queue.empty() && !voice.paused;
}

void show_subtitles(Show& show, const Teller& teller, const Utterance* utterance) {
  for (Visitor& visitor : show.visits.visitors)
    if (!is_narrated(show.visits, visitor) && listens_to(show, visitor, teller))
      show_subtitle(show, visitor, utterance, true);
}

// Moves the camera of whoever asked for the story to where its marks want it, and shows pieces as
// they say.
void follow_story(ShowVisits& visits, const ExhibitStage& stage, double time, const Teller& teller,
                  const VoiceEvents& events) {
  for (const ActionEvent& act : events.acts) {
    int viewpoint = act.kind == StoryMarkKind::view ? find_viewpoint(stage.exhibit, act.name) : -1;
    for (Visitor& visitor : visits.visitors) {
      if (visitor.link->id != teller.voice.asked_by) continue;
      if (act.kind == StoryMarkKind::show)
        see_told(stage.exhibit, time, act.name, act.piece, visitor);
      if (viewpoint >= 0 && visitor.place.tour.tour < 0 && visitor.place.move == vec3(0))
        glide_to(visitor.place.tour, viewpoint, visitor.place.view);
    }
  }
}

// Lets the narrators of tours speak, each to one visitor and those whom that visitor leads.
void narrate(Show& show, float dt) {
  for (Visitor& visitor : show.visits.visitors) {
    Narration& narration = visitor.hearing.narration;
    if (!visitor.welcomed || narration.voice.queue.empty()) continue;
    if (dt >= 1) narration.sounding.going = false;  // the show stood still while the sound went on
    VoiceEvents said = advance_narration(show, visitor, dt);
    for (Visitor& listener : show.visits.visitors) {
      if (&listener != &visitor && leader_of(show.visits, listener) != &visitor) continue;
      if (said.begun) show_subtitle(show, listener, said.begun, false);
      else if (said.fell_silent) show_subtitle(show, listener, nullptr, false);
    }
    for (const ActionEvent& act : said.acts) {
      int viewpoint =
          act.kind == StoryMarkKind::view ? find_viewpoint(show.stage.exhibit, act.name) : -1;
      if (viewpoint >= 0) glide_to(visitor.place.tour, viewpoint, visitor.place.view);
      if (act.kind == StoryMarkKind::show)
        see_told(show.stage.exhibit, show.time, act.name, act.piece, visitor);
    }
  }
}

// Gives the storyteller the guests of the kiosk that it is with; while it is with none, motion
// before any kiosk.
void see_guests(Show& show, StorytellerInput& input) {
  const Kiosk* kiosk = her_kiosk(show.kiosks);
  input.visit = show.kiosks.her_visits;
  if (kiosk) {
    input.kiosk_motion = kiosk->audience.state == Presence::motion;
    input.guests = guests_of(*kiosk, kiosk_window(show, kiosk->settings.name));
    input.staying = has_guest(kiosk->stage.now);
    input.met = kiosk->visit.greeted;
    input.parting = kiosk->changed && kiosk->stage.now == Stage::farewell;
  } else {
    for (const Kiosk& other : show.kiosks.all)
      input.kiosk_motion |= other.audience.state == Presence::motion;
  }
}

void greet_or_part(Show& show, Teller& teller, const StorytellerEvents& events) {
  const StorytellerPlace& place = *storyteller_of(show.stage, show.cast, teller);
  if (events.greeted) {
    show.totals.greetings++;
    if (Kiosk* kiosk = her_kiosk(show.kiosks)) {
      const std::string& name = kiosk->settings.name;
      if (!kiosk->visit.greeted) count(show, "kiosk_visits", name.empty() ? "-" : name);
      kiosk->visit.greeted = true;
    }
    if (teller.voice.story.empty())
      say(teller.voice, nth_line(place.greetings, show.cast.greetings++), true);
  }
  if (events.farewelled) {
    show.totals.farewells++;
    say(teller.voice, nth_line(place.farewells, show.cast.farewells++), true);
  }
}

// Lets a storyteller notice, decide, speak and pose.
void behave(Show& show, Teller& teller, float dt) {
  if (dt >= 1) teller.sounding.going = false;  // the show stood still while the sound went on
  const std::string story = teller.voice.story;
  VoiceEvents said = advance_speech(show, teller, dt);
  if (said.fell_silent && !story.empty()) count(show, "stories_heard", story);
  if (said.begun) show_subtitles(show, teller, said.begun);
  else if (said.fell_silent) show_subtitles(show, teller, nullptr);
  follow_story(show.visits, show.stage, show.time, teller, said);

  StorytellerInput input;
  input.time = show.time;
  input.dt = dt;
  if (&teller == &show.cast.teller) see_guests(show, input);
  input.humanlike = teller.humanlike;
  // The pose is made for the moment that its picture will carry.
  // Its own words come before those of a tour, which are heard by one visitor alone.
  const Voice* told = &teller.voice;
  if (const Visitor* on_tour = teller.voice.queue.empty() ? heard_on_tour(show, teller) : nullptr)
    told = &on_tour->hearing.narration.voice;
  input.speaking = speaking(*told, show.drawing->picture_lead);
  if (heard(*told)) input.visemes = mouth_shape(*told, show.drawing->picture_lead);
  input.telling = !teller.voice.story.empty();
  input.story = make_cue(show.stage.exhibit, teller.voice, said);
  for (const Visitor& visitor : show.visits.visitors) {
    if (visitor.kiosk || !listens_to(show, visitor, teller))
      continue;  // a kiosk page's eyes are its camera
    Guest guest;
    guest.id = visitor.link->id;
    guest.head = vec3(visitor.place.view.position - show.stage.exhibit.scene.origin);
    input.guests.push_back(guest);
  }
  if (const PointOfInterest* point =
          teller.voice.queue.empty() ? looked_at_beside_her(show, teller) : nullptr)
    input.story.look = vec3(point->place - show.stage.exhibit.scene.origin);
  input.viewer_distance = viewer_distance(show, teller);
  StorytellerEvents events;
  tick_storyteller(teller.mind, teller.storyteller, input, teller.pose, events);
  advance_held(show.stage.exhibit, teller.storyteller, teller.mind, teller.pose, teller.visible, dt,
               teller.held);
  greet_or_part(show, teller, events);

  bool message_due =
      show.time - teller.agent_sent_at >= agent_interval || teller.mind.mood != teller.agent_mood;
  if (!message_due) return;
  teller.agent_sent_at = show.time;
  teller.agent_mood = teller.mind.mood;
  const std::string message = agent_message(show, teller);
  for (Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && &teller_of(show.cast, show.visits, visitor) == &teller)
      visitor.link->send_text(message);
}

// Returns whether the storyteller has anything to do. A visitor's own does nothing while it is
// silent, holds nothing and is not to be seen; nor does the house's while nobody shares it.
bool is_noticed(const Show& show, const Teller& teller) {
  if (&teller == &show.cast.teller && connected_cameras(show.kiosks) > 0) return true;
  const bool news =
      !teller.voice.queue.empty() || teller.agent_sent_at < 0 || teller.held.prop >= 0;
  return std::any_of(show.visits.visitors.begin(), show.visits.visitors.end(),
                     [&](const Visitor& visitor) {
                       if (&teller_of(show.cast, show.visits, visitor) != &teller) return false;
                       return &teller == &show.cast.teller || news ||
                              sees_figure(show.cast, teller, visitor.place.last_view);
                     });
}

void behave(Show& show, float dt) {
  follow_kiosks(show);
  if (show.cast.figures.empty()) return;
  for (Teller* teller : tellers_of(show.cast, show.visits))
    if (is_noticed(show, *teller)) behave(show, *teller, dt);
}

// Does the next thing, if there is any, of all that is due by now.
void use_renderer(Show& show, int waiting) {
  RendererState renderer = renderer_state(show);
  renderer.waiting = waiting;
  carry_out(show, decide(show.time, draw_states(show), renderer), waiting);
}

// Returns rays over what visitors see.
std::vector<Ray> looks_of(const ShowVisits& visits) {
  constexpr int across = 24, down = 14;
  std::vector<Ray> rays;
  for (const Visitor& visitor : visits.visitors) {
    const View& view = visitor.picture->keyframe.view;
    for (int i = 0; i < across * down && view.width > 0; i++)
      rays.push_back(view_ray(view, (float(i % across) + 0.5f) * float(view.width) / across,
                              (float(i / across) + 0.5f) * float(view.height) / down));
  }
  return rays;
}

// Lets the baker work. All cores are free while there are no visitors, or while all have been at
// rest for long. Better light waits until nobody walks, so that it fades in, but not for ever.
void watch_baker(Show& show) {
  if (!show.stage.baker) return;
  const bool free = !show.drawing->others_draw &&
                    (show.visits.visitors.empty() || !draws(show.visits, *show.drawing, show.time));
  show.stage.baker->allow(free ? BakerCores::all : BakerCores::spare);
  BakerLooks& looks = show.stage.baker_looks;
  if (show.time - looks.told_at < looks_every) return;
  looks.told_at = show.time;
  show.stage.baker->look(looks_of(show.visits));
  const bool walks = std::ranges::any_of(show.visits.visitors, [](const Visitor& visitor) {
    return visitor.picture->drawn_at >= 0 && !is_still(visitor.picture->job);
  });
  if (walks && show.time - looks.took_at < most_light_waits) return;
  if (auto maps = show.stage.baker->take()) {
    use_better_maps(show.stage, show.visits, std::move(maps));
    looks.took_at = show.time;
  }
}

// Slows a camera on its way down to keyframes that are slow; a visitor's own turn does not wait.
void pace_tour(Visitor& visitor) {
  double seconds = 0.001 * double(std::max(visitor.times.interval, visitor.times.whole));
  const PictureWishes& wants = visitor.wants;
  VisitorPlace& place = visitor.place;
  float across =
      2 * std::atan(std::tan(0.5f * place.view.fov) * float(wants.width) / float(wants.height));
  auto pace = [&](const std::shared_ptr<const CameraPath>& path, double time) {
    return tour_pace(path ? turn_ahead(*path, time, seconds) : 0, across);
  };
  place.tour.most_pace = pace(place.tour.path, place.tour.time);
  place.glide.most_pace = pace(place.glide.path, place.glide.time);
}

// Sends a page that moves its own camera the view to which it is led, or has to be.
void send_pose(const ExhibitStage& stage, const ShowVisits& visits, double time, Visitor& visitor) {
  const View& view = visitor.place.last_view;
  // a kiosk's window follows a head at once
  const double interval = visitor.kiosk ? 0 : pose_interval;
  if (!visitor.wants.local || view == visitor.posed || time - visitor.posed_at < interval) return;
  visitor.posed = view;
  visitor.posed_at = time;
  visitor.link->send_text(pose_message(stage, visits, visitor));
}

void send_state(Show& show, Visitor& visitor) {
  double interval = visitor.hearing.utterance != 0 ? heard_state_interval : state_interval;
  if (show.time - visitor.state_sent_at < interval) return;
  visitor.state_sent_at = show.time;
  const Visitor* camera = camera_of(std::as_const(show.visits), visitor);
  visitor.link->send_text(state_message(show, camera ? *camera : visitor));
}

}  // namespace

void tick(Show& show, Arrivals& arrivals, double now) {
  float dt = show.ticks == 0 ? 0 : float(std::clamp(now - show.time, 0.0, 1.0));
  show.time = std::max(show.time, now);
  show.time_us = microseconds_now();
  show.ticks++;
  double began = seconds_now();

  bool free = take_finished(show);
  if (!free || show.drawing->renderer.drawn) show.drawing->drew_at = show.time;
  welcome_links(show, arrivals);
  follow_house(show, arrivals);
  read_visitors(show, double(dt));
  read_cameras(show.kiosks, show.totals, show.time);
  if (free) forget_lights(show.stage, show.visits);
  for (Visitor& visitor : show.visits.visitors)
    if (visitor.welcomed && !visitor.picture->at_work &&
        show.drawing->renderer.drawn != visitor.link->id) {
      if (lamps_wait(show, visitor)) light_lamps(show, visitor);
      follow_wish(show, visitor);
    }
  mind_workers(show);
  if (free) take_deliveries(show);
  if (free && !show.drawing->renderer.drawn) watch_baker(show);
  narrate(show, dt);
  Demand demand;
  if (free) demand = find_demand(show.time, draw_states(show), renderer_state(show));
  // The storyteller moves for a picture; otherwise often enough to notice people.
  const bool poses = demand.waiting > 0 || demand.moving;
  if (poses || show.time - show.cast.behaved_at >= behave_interval) {
    behave(show, show.cast.behaved_at < 0
                     ? 0
                     : float(std::clamp(show.time - show.cast.behaved_at, 0.0, 1.0)));
    show.cast.behaved_at = show.time;
    show.totals.animate_ms = float(1000 * (seconds_now() - began));
  }
  send_sounds(show);
  for (Visitor& visitor : show.visits.visitors) {
    if (!visitor.welcomed || visitor.wall.role == WallRole::tile) continue;
    std::optional<dvec3> person;
    const Teller& teller = teller_of(show.cast, show.visits, visitor);
    if (const StorytellerPlace* who =
            teller.visible ? storyteller_of(show.stage, show.cast, teller) : nullptr)
      person = who->position;
    pace_tour(visitor);
    TourStep step = move_visitor(visitor.place, visitor.hearing.narration.voice, *show.stage.world,
                                 show.stage.exhibit, show.stage.roads, person, dt);
    if (!is_of_wall(visitor)) count_place(show, visitor, step.finished, double(dt));
    if (step.arrived >= 0 || step.finished) visitor.state_sent_at = -1e9;
    follow_leader(show.visits, show.time, visitor, dt);
    look_through(show, visitor, dt);
    watch(show, visitor);
  }
  watch_pass(show);
  Renderer& renderer = show.drawing->renderer;
  if (renderer.drawn != 0 &&
      is_outdated(show, renderer.job, visitor_of(show.visits, renderer.drawn)))
    renderer.given_up = true;
  if (free) use_renderer(show, demand.waiting);
  steer(show);
  present_all(show);
  for (Visitor& visitor : show.visits.visitors) {
    if (!visitor.welcomed || visitor.wall.role == WallRole::camera) continue;
    send_pose(show.stage, show.visits, show.time, visitor);
    send_state(show, visitor);
    if (!is_of_wall(visitor)) send_token(show, visitor);
  }
  show.totals.tick_ms = float(1000 * (seconds_now() - began));
}

double seconds_to_next_tick(const Show& show, double now) {
  double wait = 1 / 20.0;  // nobody looks: only clocks and arrivals
  for (const Visitor& visitor : show.visits.visitors)
    if (is_shown(visitor)) {
      wait = std::min(wait, listening_interval);
      if (!has_to_show(show, visitor)) continue;
      double due = visitor.shown.pictured_at + 1 / picture_rate(show, visitor);
      wait = std::min(wait, due - now);
    }
  return std::max(wait, least_wait);
}

void wait_for_tick(const Show& show, double now) {
  double seconds = seconds_to_next_tick(show, now);
  const Renderer& renderer = show.drawing->renderer;
  bool nothing_comes = renderer.drawn == 0 && renderer.asking.empty() &&
                       !show.drawing->pass.at_work && !renderer.skin.at_work;
  if (nothing_comes) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  else renderer.worker.wait_for(seconds);
}

}  // namespace wellspring::show
