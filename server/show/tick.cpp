// SPDX-License-Identifier: Apache-2.0
#include "show/tick.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "show/answer/commands.h"
#include "show/answer/events.h"
#include "show/answer/sound.h"
#include "show/draw/carry_out.h"
#include "show/draw/make_picture_job.h"
#include "show/draw/pace.h"
#include "show/draw/present.h"
#include "show/draw/steer.h"
#include "show/draw/still_pass.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/storyteller/story_marks.h"
#include "wire/json.h"

namespace wellspring {

namespace {

constexpr double agent_interval = 0.1;  // seconds between agent messages while somebody listens
constexpr double state_interval = 0.5;
constexpr double heard_state_interval = 0.1;  // while there is sound to be heard from somewhere
constexpr double behave_interval = 0.04;
constexpr double idle_before_bake = 5;       // seconds in which nothing was drawn
constexpr double least_wait = 0.001;         // between ticks, whatever is due
constexpr double listening_interval = 0.01;  // between looks at what visitors want, pictures or not

void welcome_links(Show& show, Arrivals& arrivals) {
  for (std::shared_ptr<Link>& link : arrivals.take()) {
    if (link->kind == LinkKind::eye) {
      log::info("kiosk camera {} connected from {}", link->id, link->peer);
      show.eyes.push_back(Eye{std::move(link), {}, -1e9, 0, 0});
    } else if (int(show.visitors.size()) >= show.settings.max_visitors) {
      show.totals.turned_away++;
      link->send_text(write_error({"full",
                                   "this exhibit has as many visitors as it can serve; please "
                                   "come back in a moment"}));
      link->close("full");
    } else {
      log::info("visitor {} connected from {}", link->id, link->peer);
      Visitor& visitor = show.visitors.emplace_back();
      visitor.link = std::move(link);
      visitor.picture.cache = RenderCache({}, show.renderer.work.cache);
      visitor.picture.compositor = Compositor(show.renderer.work.compositor);
      visitor.picture.compositor.set_skin(&show.skin);
    }
  }
}

void read_visitors(Show& show) {
  for (Visitor& visitor : show.visitors)
    for (const std::string& text : visitor.link->take_texts()) {
      show.totals.messages++;
      auto message = read_browser_message(text);
      std::optional<WireError> error;
      if (const WireError* bad = std::get_if<WireError>(&message)) error = *bad;
      else error = handle(show, visitor, std::get<BrowserMessage>(message));
      if (!error) continue;
      show.totals.refused_messages++;
      visitor.link->send_text(write_error(*error));
    }
  std::erase_if(show.visitors, [&show](Visitor& visitor) {
    bool gone = visitor.left || visitor.link->closed();
    if (gone) {
      visitor.left = true;
      visitor.welcomed = false;
      visitor.link->close("bye");
      bool in_pass = show.pass.visitor == &visitor;
      if (in_pass) show.pass.given_up = true;
      if (visitor.picture.at_work || in_pass) return false;  // soon
      log::info("visitor {} left", visitor.link->id);
    }
    return gone;
  });
  forget_absent_listeners(show);
}

void read_cameras(Show& show) {
  for (Eye& eye : show.eyes)
    for (const std::string& text : eye.link->take_texts()) {
      auto observation = read_observation(text);
      if (const WireError* bad = std::get_if<WireError>(&observation)) {
        eye.refused++;
        show.totals.refused_messages++;
        eye.link->send_text(write_error(*bad));
        continue;
      }
      eye.seen = std::move(std::get<Observation>(observation));
      eye.received = show.time;
      eye.observations++;
      show.totals.observations++;
    }
  std::erase_if(show.eyes, [](const Eye& eye) {
    if (eye.link->closed()) log::info("kiosk camera {} disconnected", eye.link->id);
    return eye.link->closed();
  });
}

void broadcast(Show& show, const std::string& message) {
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed) visitor.link->send_text(message);
}

void show_subtitle(const Show& show, Visitor& visitor, const Utterance* utterance,
                   bool storyteller) {
  const Exhibit& exhibit = show.exhibit;
  const StorytellerPlace* storyteller_place = storyteller_of(show);
  std::string text, speaker;
  if (const auto* line =
          utterance ? line_in(utterance->line, visitor.lang, exhibit.languages) : nullptr)
    text = line->second.text;
  if (storyteller_place && storyteller)
    speaker = text_in(storyteller_place->name, visitor.lang, exhibit.languages);
  visitor.link->send_text(
      subtitle_message(text, visitor.lang, speaker, utterance ? utterance->seconds : 0));
}

bool is_narrated(const Visitor& visitor) {
  return !visitor.hearing.narration.voice.queue.empty() && !visitor.hearing.narration.voice.paused;
}

void show_subtitles(Show& show, const Utterance* utterance) {
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed && !is_narrated(visitor)) show_subtitle(show, visitor, utterance, true);
}

// The camera of whoever asked for the story goes where its marks want it.
void follow_story(Show& show, const VoiceEvents& events) {
  for (const ActionEvent& act : events.acts) {
    int viewpoint = act.kind == StoryMarkKind::view ? find_viewpoint(show.exhibit, act.name) : -1;
    if (viewpoint < 0) continue;
    for (Visitor& visitor : show.visitors)
      if (visitor.link->id == show.voice.asked_by && visitor.place.tour.tour < 0 &&
          visitor.place.move == vec3(0))
        glide_to(visitor.place.tour, viewpoint, visitor.place.view);
  }
}

// Tours: their narrators speak, each to one visitor.
void narrate(Show& show, float dt) {
  for (Visitor& visitor : show.visitors) {
    Narration& narration = visitor.hearing.narration;
    if (!visitor.welcomed || narration.voice.queue.empty()) continue;
    if (dt >= 1) narration.sounding.going = false;  // the show stood still while the sound went on
    VoiceEvents said = advance_narration(show, visitor, dt);
    if (said.begun) show_subtitle(show, visitor, said.begun, false);
    else if (said.fell_silent) show_subtitle(show, visitor, nullptr, false);
    for (const ActionEvent& act : said.acts) {
      int viewpoint = act.kind == StoryMarkKind::view ? find_viewpoint(show.exhibit, act.name) : -1;
      if (viewpoint >= 0) glide_to(visitor.place.tour, viewpoint, visitor.place.view);
    }
  }
}

View kiosk_view(const Show& show) {
  const Viewpoint& at = show.exhibit.viewpoints[size_t(storyteller_of(show)->kiosk_viewpoint)].view;
  return make_view(show.exhibit.scene, at.position, at.yaw, at.pitch, at.fov, 16, 9);
}

// Storyteller: notices, decides, speaks, poses. Left out while nobody could see or hear it.
void behave(Show& show, float dt) {
  if (show.figures.empty()) return;
  show.audience = gather_audience(show.eyes, kiosk_view(show), show.time);
  std::string message = kiosk_message(show.audience, show.eyes.size());
  if (message != show.kiosk_message) broadcast(show, show.kiosk_message = message);
  if (show.visitors.empty() && show.eyes.empty()) return;

  if (dt >= 1) show.sounding.going = false;  // the show stood still while the sound went on
  VoiceEvents said = advance_speech(show, dt);
  if (said.begun) show_subtitles(show, said.begun);
  else if (said.fell_silent) show_subtitles(show, nullptr);
  follow_story(show, said);

  StorytellerInput input;
  input.time = show.time;
  input.dt = dt;
  input.kiosk_motion = show.audience.state == Presence::motion;
  input.guests = show.audience.guests;
  input.humanlike = show.humanlike;
  // The pose is made for the moment that its picture will carry.
  // Its own words come before those of a tour, which are heard by one visitor alone.
  const Voice* told = &show.voice;
  if (const Visitor* on_tour = show.voice.queue.empty() ? heard_on_tour(show) : nullptr)
    told = &on_tour->hearing.narration.voice;
  input.speaking = speaking(*told, show.picture_lead);
  if (heard(*told)) input.visemes = mouth_shape(*told, show.picture_lead);
  input.telling = !show.voice.story.empty();
  input.story = make_cue(show.exhibit, show.voice, said);
  for (const Visitor& visitor : show.visitors) {
    if (!visitor.welcomed || visitor.kiosk) continue;  // a kiosk page's eyes are its camera
    Guest guest;
    guest.id = uint32_t(visitor.link->id);
    guest.head = vec3(visitor.place.view.position - show.exhibit.scene.origin);
    input.guests.push_back(guest);
  }
  input.viewer_distance = viewer_distance(show);
  StorytellerEvents events;
  tick_storyteller(show.mind, show.storyteller, input, show.pose, events);
  const StorytellerPlace& place = *storyteller_of(show);
  if (events.greeted) {
    show.totals.greetings++;
    if (show.voice.story.empty())
      say(show.voice, nth_line(place.greetings, show.greetings++), true);
  }
  if (events.farewelled) {
    show.totals.farewells++;
    say(show.voice, nth_line(place.farewells, show.farewells++), true);
  }

  bool message_due =
      show.time - show.agent_sent_at >= agent_interval || show.mind.mood != show.agent_mood;
  if (message_due) {
    show.agent_sent_at = show.time;
    show.agent_mood = show.mind.mood;
    broadcast(show, agent_message(show));
  }
}

// The next thing, if there is any, of what is due by now.
void use_renderer(Show& show, int waiting) {
  RendererState renderer = renderer_state(show);
  renderer.waiting = waiting;
  carry_out(show, decide(show.time, draw_states(show), renderer), waiting);
}

// The cores are free while there are no visitors, or while all have been at rest for long. What
// changes the kind of light is taken over while nobody looks.
void watch_baker(Show& show) {
  if (!show.baker) return;
  const bool alone = show.visitors.empty();
  if (alone || show.lights.maps)
    if (auto maps = show.baker->take()) use_maps(show, std::move(maps));
  show.baker->allow(alone || show.time - show.drew_at > idle_before_bake);
}

// A tour's camera waits for keyframes that are slow; a visitor's own turn does not.
void pace_tour(Visitor& visitor) {
  double seconds = 0.001 * double(std::max(visitor.times.interval, visitor.times.whole));
  const PictureWishes& wants = visitor.wants;
  VisitorPlace& place = visitor.place;
  float across =
      2 * std::atan(std::tan(0.5f * place.view.fov) * float(wants.width) / float(wants.height));
  place.tour.most_pace = tour_pace(turn_ahead(place.tour, seconds), across);
}

void send_state(Show& show, Visitor& visitor) {
  double interval = visitor.hearing.utterance != 0 ? heard_state_interval : state_interval;
  if (show.time - visitor.state_sent_at < interval) return;
  visitor.state_sent_at = show.time;
  visitor.link->send_text(state_message(show, visitor));
}

}  // namespace

void tick(Show& show, Arrivals& arrivals, double now) {
  float dt = show.ticks == 0 ? 0 : float(std::clamp(now - show.time, 0.0, 1.0));
  show.time = std::max(show.time, now);
  show.time_us = microseconds_now();
  show.ticks++;
  double began = seconds_now();

  bool free = take_finished(show);
  if (!free || show.renderer.drawn) show.drew_at = show.time;
  welcome_links(show, arrivals);
  read_visitors(show);
  read_cameras(show);
  if (free) invalidate_light_steps(show);
  if (free && !show.renderer.drawn && lamps_wait(show)) light_lamps(show);
  if (free && !show.renderer.drawn) watch_baker(show);
  narrate(show, dt);
  Demand demand;
  if (free) demand = find_demand(show.time, draw_states(show), renderer_state(show));
  // The storyteller moves for a picture; otherwise often enough to notice people.
  const bool poses = demand.waiting > 0 || demand.moving;
  if (poses || show.time - show.behaved_at >= behave_interval) {
    behave(show,
           show.behaved_at < 0 ? 0 : float(std::clamp(show.time - show.behaved_at, 0.0, 1.0)));
    show.behaved_at = show.time;
    show.totals.animate_ms = float(1000 * (seconds_now() - began));
  }
  send_sounds(show);
  std::optional<dvec3> person;
  if (const StorytellerPlace* storyteller_place =
          show.storyteller_visible ? storyteller_of(show) : nullptr)
    person = storyteller_place->position;
  for (Visitor& visitor : show.visitors) {
    if (!visitor.welcomed) continue;
    pace_tour(visitor);
    TourStep step = move_visitor(visitor.place, visitor.hearing.narration.voice, *show.world,
                                 show.exhibit, show.roads, person, dt);
    if (step.arrived >= 0 || step.finished) visitor.state_sent_at = -1e9;
    watch(show, visitor);
  }
  watch_pass(show);
  Renderer& renderer = show.renderer;
  if (renderer.drawn && is_outdated(show, renderer.job, *renderer.drawn)) renderer.given_up = true;
  if (!show.settings.background) draw_now(show, demand.waiting);
  else if (free) use_renderer(show, demand.waiting);
  steer(show);
  for (Visitor& visitor : show.visitors) {
    if (!visitor.welcomed) continue;
    if (show.settings.background) present(show, visitor);
    send_state(show, visitor);
  }
  show.totals.tick_ms = float(1000 * (seconds_now() - began));
}

double seconds_to_next_tick(const Show& show, double now) {
  double wait = 1 / 20.0;  // nobody looks: only clocks and doors
  for (const Visitor& visitor : show.visitors)
    if (visitor.welcomed) {
      double due = visitor.shown.pictured_at + 1 / picture_rate(show, visitor);
      wait = std::min({wait, listening_interval, due - now});
    }
  return std::max(wait, least_wait);
}

void wait_for_tick(const Show& show, double now) {
  double seconds = seconds_to_next_tick(show, now);
  const Renderer& renderer = show.renderer;
  bool nothing_comes =
      !renderer.drawn && renderer.brokers.empty() && !show.pass.at_work && !renderer.skin.at_work;
  if (nothing_comes) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  else renderer.worker.wait_for(seconds);
}

}  // namespace wellspring
