// SPDX-License-Identifier: Apache-2.0
#include "show/answer/commands.h"

#include <algorithm>
#include <cmath>

#include "show/answer/events.h"
#include "show/state/lamps.h"
#include "show/state/make_show.h"

namespace wellspring {

namespace {

using Answer = std::optional<WireError>;

constexpr float steepest = 1.45f;  // radians a visitor may look up or down
constexpr double farthest = 1e7;   // metres from the scene's origin a camera may be put

void set_size(PictureWishes& wants, const ShowSettings& settings, int width, int height) {
  width = std::clamp(width, 16, 4096);
  height = std::clamp(height, 16, 4096);
  double pixels = double(width) * height;
  if (pixels > settings.max_pixels) {  // the same shape, as many pixels as a visitor may have
    double scale = std::sqrt(settings.max_pixels / pixels);
    width = int(width * scale);
    height = int(height * scale);
  }
  // Multiples of 8: whole JPEG blocks, and no resize for a page that is a few pixels off.
  wants.width = std::max(16, width / 8 * 8);
  wants.height = std::max(16, height / 8 * 8);
}

int find_tour(const Exhibit& exhibit, const std::string& id) {
  for (size_t i = 0; i < exhibit.tours.size(); i++)
    if (exhibit.tours[i].id == id || id.empty()) return int(i);
  return -1;
}

const StoryText* find_story(const Exhibit& exhibit, const std::string& id) {
  for (const StoryText& story : exhibit.stories)
    if (story.id == id) return &story;
  return nullptr;
}

Answer handle_one(Show& show, Visitor& visitor, const Hello& hello) {
  if (!hello.exhibit.empty() && hello.exhibit != show.exhibit.id)
    return WireError{"unknown_exhibit", "there is no exhibit '" + hello.exhibit +
                                            "' here; this is '" + show.exhibit.id + "'"};
  visitor.lang = hello.lang.empty() ? show.exhibit.languages.front() : hello.lang;
  visitor.kiosk = hello.role == "kiosk";
  visitor.name = hello.kiosk;
  set_size(visitor.wants, show.settings, hello.width, hello.height);
  const StorytellerPlace* storyteller_place = storyteller_of(show);
  go_to_viewpoint(
      visitor.place, visitor.hearing.narration.voice, show.exhibit,
      visitor.kiosk && storyteller_place ? storyteller_place->kiosk_viewpoint : show.exhibit.start);
  visitor.welcomed = true;
  show.totals.visits++;
  visitor.link->send_text(welcome_message(show, visitor));
  visitor.link->send_text(agent_message(show));
  if (!show.kiosk_message.empty()) visitor.link->send_text(show.kiosk_message);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const Input& input) {
  VisitorPlace& place = visitor.place;
  if (input.pointer) visitor.looks.pointer = input.pointer, visitor.looks.pointed_at = show.time;
  place.seq = input.seq;
  place.move = input.move;
  if (input.look != vec2(0) && place.tour.state == TourRide::State::playing) {
    look_round(place.tour, input.look);
  } else if (input.look != vec2(0)) {
    place.view.yaw = std::remainder(place.view.yaw + input.look.x, 2 * pi);
    place.view.pitch = std::clamp(place.view.pitch + input.look.y, -steepest, steepest);
    place.viewpoint = -1;
    place.tour.pace = 0;  // a paused ride does not come to rest by itself any more
  }
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const CameraTo& camera) {
  VisitorPlace& place = visitor.place;
  if (glm::length(camera.position - show.exhibit.scene.origin) > farthest)
    return WireError{"bad_field", "camera.position: is farther than 1e7 m from the exhibit"};
  place.seq = camera.seq;
  place.view.position = camera.position;
  place.view.yaw = std::remainder(camera.yaw, 2 * pi);
  place.view.pitch = std::clamp(camera.pitch, -steepest, steepest);
  place.move = place.velocity = vec3(0);
  place.viewpoint = -1;
  stop_tour(place.tour, visitor.hearing.narration.voice);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const ViewpointTo& to) {
  int index = find_viewpoint(show.exhibit, to.name);
  if (index < 0) return WireError{"unknown_viewpoint", "there is no viewpoint '" + to.name + "'"};
  visitor.place.seq = to.seq;
  go_to_viewpoint(visitor.place, visitor.hearing.narration.voice, show.exhibit, index);
  return {};
}

// Subtitles go with what is broken off.
void clear_subtitle(Visitor& visitor) {
  visitor.link->send_text(subtitle_message("", visitor.lang, "", 0));
}

void fall_silent(Show& show) {
  bool shown = show.voice.started;
  hush(show.voice);
  for (Visitor& visitor : show.visitors) {
    const Voice& own = visitor.hearing.narration.voice;
    if (shown && visitor.welcomed && (own.queue.empty() || own.paused)) clear_subtitle(visitor);
  }
}

Answer handle_one(Show& show, Visitor& visitor, const Tour& order) {
  VisitorPlace& place = visitor.place;
  Voice& narrator = visitor.hearing.narration.voice;
  switch (order.action) {
    case TourAction::play: {
      bool resume =
          order.name.empty() && place.tour.state == TourRide::State::paused && place.tour.tour >= 0;
      int tour = resume ? place.tour.tour : find_tour(show.exhibit, order.name);
      if (tour < 0) return WireError{"unknown_tour", "there is no tour '" + order.name + "'"};
      place.move = place.velocity = vec3(0);
      if (show.voice.asked_by == visitor.link->id) fall_silent(show);  // one voice at a time
      start_tour(place.tour, narrator, tour, show.exhibit, show.roads, place.view);
      break;
    }
    case TourAction::pause: pause_tour(place.tour, narrator); break;
    case TourAction::stop:
      if (narrator.started) clear_subtitle(visitor);
      stop_tour(place.tour, narrator);
      break;
  }
  visitor.state_sent_at = -1e9;
  return {};
}

// Kiosks stand before whoever is there.
void call_storyteller(Show& show, size_t storyteller_index) {
  if (storyteller_index == show.storyteller_index) return;
  fall_silent(show);
  change_storyteller(show, storyteller_index);
  for (Visitor& visitor : show.visitors)
    if (visitor.welcomed && visitor.kiosk && visitor.place.tour.state == TourRide::State::none)
      go_to_viewpoint(visitor.place, visitor.hearing.narration.voice, show.exhibit,
                      storyteller_of(show)->kiosk_viewpoint);
}

const Visitor* who_asked(const Show& show) {
  for (const Visitor& visitor : show.visitors)
    if (visitor.link->id == show.voice.asked_by) return &visitor;
  return nullptr;
}

// Visitors share the storyteller as equals, but nobody far away takes it from a person who stands
// before it and is being told a story.
bool belongs_to_a_kiosk(const Show& show, const Visitor& other) {
  if (show.voice.story.empty() || other.kiosk) return false;
  const Visitor* asked = who_asked(show);
  return asked && asked->kiosk;
}

Answer handle_one(Show& show, Visitor& visitor, const StorytellerOrder& order) {
  if (!storyteller_of(show)) return WireError{"no_storyteller", "this exhibit has no storyteller"};
  if (belongs_to_a_kiosk(show, visitor))
    return WireError{"storyteller_busy", "somebody at the kiosk is being told a story"};
  if (!order.teller.empty()) {
    int storyteller_index = find_storyteller(show.exhibit, order.teller);
    if (storyteller_index < 0)
      return WireError{"unknown_storyteller", "there is no storyteller '" + order.teller + "'"};
    call_storyteller(show, size_t(storyteller_index));
  }
  if (order.visible) show.storyteller_visible = *order.visible;
  if (order.humanlike) show.humanlike = *order.humanlike;
  if (!order.story.empty()) {
    const StoryText* story = find_story(show.exhibit, order.story);
    if (!story) return WireError{"unknown_story", "there is no story '" + order.story + "'"};
    if (story->storyteller_index >= 0) call_storyteller(show, size_t(story->storyteller_index));
    tell(show.voice, *story);
    pause_tour(visitor.place.tour, visitor.hearing.narration.voice);
    show.voice.asked_by = visitor.link->id;
    show.totals.stories++;
  }
  const StoryText* telling = find_story(show.exhibit, show.voice.story);
  uint64_t asked_by = show.voice.asked_by;
  if (order.action == "pause") pause_voice(show.voice);
  else if (order.action == "play") resume_voice(show.voice);
  else if (order.action == "stop") fall_silent(show);
  else if (order.action == "restart" && telling) tell(show.voice, *telling);
  else if (order.action == "skip" && telling) tell(show.voice, *telling, show.voice.sentence + 1);
  if (!show.voice.queue.empty()) show.voice.asked_by = asked_by;
  show.agent_sent_at = -1e9;  // everybody hears of the change with the next tick
  return {};
}

Answer handle_one(Show& show, Visitor&, const LampOrder& order) {
  if (switch_lamp(show, order.name, order.on)) return {};
  return WireError{"unknown_lamp", "there is no lamp '" + order.name + "'"};
}

Answer handle_one(Show& show, Visitor& visitor, const Settings& settings) {
  PictureWishes& wants = visitor.wants;
  if (settings.fps) wants.fps = std::clamp(*settings.fps, 0.0f, 120.0f);
  if (settings.sound) visitor.hearing.wanted = *settings.sound;
  if (settings.quality) wants.best_quality = *settings.quality;
  if (settings.max_quality) wants.still_quality = *settings.max_quality;
  wants.best_quality = std::min(wants.best_quality, wants.still_quality);
  if (settings.attention) {
    const bool* on = std::get_if<bool>(&*settings.attention);
    wants.attention = !on || *on;
    if (!on) wants.task_weight = std::get<float>(*settings.attention);
  }
  if (settings.width || settings.height)
    set_size(visitor.wants, show.settings, settings.width.value_or(wants.width),
             settings.height.value_or(wants.height));
  if (!settings.lang.empty() && settings.lang != visitor.lang) {
    visitor.lang = settings.lang;
    visitor.link->send_text(welcome_message(show, visitor));
  }
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const Ack& ack) {
  note_ack(visitor.shown.flow, ack.frame, ack.decoded_ms, show.time);
  return {};
}

Answer handle_one(Show&, Visitor& visitor, const Bye&) {
  visitor.left = true;
  return {};
}

}  // namespace

void forget_absent_listeners(Show& show) {
  if (show.voice.queue.empty()) return;
  bool nobody = show.visitors.empty();
  bool abandoned = show.voice.paused && show.voice.asked_by != 0 && !who_asked(show);
  if (!nobody && !abandoned) return;
  fall_silent(show);
  show.agent_sent_at = -1e9;
}

std::optional<WireError> handle(Show& show, Visitor& visitor, const BrowserMessage& message) {
  bool may_speak = visitor.welcomed || std::holds_alternative<Hello>(message) ||
                   std::holds_alternative<Bye>(message);
  if (!may_speak) return WireError{"hello_first", "the first message must be hello"};
  return std::visit([&](const auto& one) { return handle_one(show, visitor, one); }, message);
}

}  // namespace wellspring
