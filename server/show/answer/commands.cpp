// SPDX-License-Identifier: Apache-2.0
#include "show/answer/commands.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "show/answer/cameras.h"
#include "show/answer/come_back.h"
#include "show/answer/events.h"
#include "show/answer/go.h"
#include "show/answer/groups.h"
#include "show/answer/idle.h"
#include "show/count/count.h"
#include "show/exhibit/pieces/exhibit_scans.h"
#include "show/state/visitor_world.h"
#include "show/state/in_view.h"
#include "show/state/lamps.h"
#include "show/state/make_show.h"
#include "show/state/visitor_picture.h"
#include "show/visit/good_view.h"
#include "wire/json.h"

namespace wellspring::show {

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

// Larger pictures need room, as a newcomer does.
Answer set_size(Visitor& visitor, const ShowSettings& settings, int width, int height) {
  PictureWishes& wants = visitor.wants;
  PictureWishes sized = wants;
  set_size(sized, settings, width, height);
  if (visitor.seat && !visitor.seat->resize({double(sized.width) * sized.height, wants.local}))
    return WireError{"no_room", fmt::format("there is no room for larger pictures at the moment: "
                                            "they stay {}x{}",
                                            wants.width, wants.height)};
  wants = sized;
  return {};
}

// A page that had keyframes gets a finished picture next, and the other way round.
void set_display(const Show& show, Visitor& visitor, const std::string& display) {
  const bool local = display == "local" && visitor.wall.role != WallRole::tile;
  PictureWishes& wants = visitor.wants;
  if (wants.local == local) return;
  wants.local = local;
  if (visitor.seat) visitor.seat->resize({double(wants.width) * wants.height, local});
  visitor.picture->around = {};
  visitor.picture->layer_unsent = visitor.shown.has_layer = false;
  visitor.shown.lost = true;
}

int find_tour(const Exhibit& exhibit, const std::string& id) {
  for (size_t i = 0; i < exhibit.tours.size(); i++)
    if (exhibit.tours[i].id == id || id.empty()) return int(i);
  return -1;
}

Answer handle_one(Show& show, Visitor& visitor, const Hello& hello) {
  if (!hello.exhibit.empty() && hello.exhibit != show.stage.exhibit.id)
    return WireError{"unknown_exhibit", "there is no exhibit '" + hello.exhibit +
                                            "' here; this is '" + show.stage.exhibit.id + "'"};
  std::string kiosk;
  if (Answer wrong = check_page(show.settings.kiosk_tokens, *visitor.link, hello, kiosk))
    return wrong;
  visitor.lang = hello.lang.empty() ? show.stage.exhibit.languages.front() : hello.lang;
  visitor.kiosk = hello.role == "kiosk";
  visitor.name = kiosk;
  if (!visitor.welcomed && hello.wall) {
    visitor.wall.role = hello.wall->column ? WallRole::tile : WallRole::leader;
    visitor.wall.part = *hello.wall;
    visitor.shown.lost = true;  // its first picture comes although nothing changes
  }
  set_display(show, visitor, hello.display);
  if (Answer wrong = set_size(visitor, show.settings, hello.width, hello.height))
    visitor.link->send_text(write_error(*wrong));
  visitor.wants.parts = hello.parts.value_or(false) && visitor.wall.role != WallRole::tile;
  const bool is_first = !visitor.welcomed;
  visitor.welcomed = true;
  kiosk = kiosk_name(show, visitor.name);
  go_to_viewpoint(
      visitor.place, visitor.hearing.narration.voice, show.stage.exhibit,
      visitor.kiosk ? kiosk_viewpoint(show.stage, show.cast, kiosk) : show.stage.exhibit.start);
  // Another thread may be drawing a picture of a visitor who is here already.
  const bool goes_on = is_first && !hello.resume.empty() && come_back(show, visitor, hello.resume);
  if (!goes_on) show.totals.visits++;
  if (is_first && !is_of_wall(visitor)) count_visit(show, visitor, goes_on);
  visitor.link->send_text(welcome_message(show, visitor, goes_on));
  visitor.link->send_text(agent_message(show, teller_of(show.cast, show.visits, visitor)));
  const Kiosk* own = kiosk_of(show, visitor);
  const std::string& state = own ? own->message : show.kiosks.message;
  if (!state.empty() && (own || !visitor.kiosk)) visitor.link->send_text(state);
  tell_house(show.house, show.time, visitor);
  if (!show.stage.problems_message.empty()) visitor.link->send_text(show.stage.problems_message);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const Input& input) {
  VisitorPlace& place = visitor.place;
  if (input.pointer) visitor.looks.pointer = input.pointer, visitor.looks.pointed_at = show.time;
  place.seq = input.seq;
  if (input.move != vec3(0)) go_away(visitor);
  if (leader_of(show.visits, visitor)) {  // looks round from the leader's place
    VisitorGroup& group = visitor.group;
    group.look = glm::clamp(group.look + input.look, vec2(-pi), vec2(pi));
    if (input.look != vec2(0)) group.looked_at = show.time;
    return {};
  }
  place.move = input.move;
  if (place.around.point >= 0) turn_around(input.look, place.around);
  else if (input.look != vec2(0) && place.tour.state == TourRide::State::playing) {
    look_round(place.tour, input.look);
  } else if (input.look != vec2(0)) {
    place.glide = {};
    place.view.yaw = std::remainder(place.view.yaw + input.look.x, 2 * pi);
    place.view.pitch = std::clamp(place.view.pitch + input.look.y, -steepest, steepest);
    place.viewpoint = -1;
    place.tour.pace = 0;  // a paused ride does not come to rest by itself any more
  }
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const CameraTo& camera) {
  VisitorPlace& place = visitor.place;
  if (glm::length(camera.position - show.stage.exhibit.scene.origin) > farthest)
    return WireError{"bad_field", "camera.position: is farther than 1e7 m from the exhibit"};
  go_away(visitor);
  place.seq = camera.seq;
  place.view.position = camera.position;
  place.view.yaw = std::remainder(camera.yaw, 2 * pi);
  place.view.pitch = std::clamp(camera.pitch, -steepest, steepest);
  place.view.roll = std::remainder(camera.roll, 2 * pi);
  place.move = place.velocity = vec3(0);
  place.viewpoint = -1;
  stand(place);
  stop_tour(place.tour, visitor.hearing.narration.voice);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const ViewpointTo& to) {
  int index = find_viewpoint(show.stage.exhibit, to.name);
  if (index < 0) return WireError{"unknown_viewpoint", "there is no viewpoint '" + to.name + "'"};
  go_away(visitor);
  visitor.place.seq = to.seq;
  go_to_viewpoint(visitor.place, visitor.hearing.narration.voice, show.stage.exhibit, index);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const GoTo& order) {
  return go(show, visitor, order);
}

Answer handle_one(Show& show, Visitor& visitor, const Tour& order) {
  VisitorPlace& place = visitor.place;
  Voice& narrator = visitor.hearing.narration.voice;
  if (Answer wrong = check_not_following(show.visits, visitor)) return wrong;
  switch (order.action) {
    case TourAction::play: {
      bool resume =
          order.name.empty() && place.tour.state == TourRide::State::paused && place.tour.tour >= 0;
      int tour = resume ? place.tour.tour : find_tour(show.stage.exhibit, order.name);
      if (tour < 0) return WireError{"unknown_tour", "there is no tour '" + order.name + "'"};
      place.move = place.velocity = vec3(0);
      stand(place);
      Teller& teller = teller_of(show.cast, show.visits, visitor);
      if (teller.voice.asked_by == visitor.link->id)
        fall_silent(show, teller);  // one voice at a time
      start_tour(place.tour, narrator, tour, show.stage.exhibit, show.stage.roads, place.view);
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

Answer handle_one(Show& show, Visitor& visitor, const LampOrder& order) {
  if (Answer wrong = check_not_following(show.visits, visitor)) return wrong;
  const int lamp = find_lamp(show.stage.exhibit, order.name);
  if (lamp < 0) return WireError{"unknown_lamp", "there is no lamp '" + order.name + "'"};
  LampSwitch to = order.on ? 1 : 0;
  if (order.on && !order.light.empty() &&
      order.light != show.stage.exhibit.lamps[size_t(lamp)].spectrum) {
    const auto& dial = show.stage.exhibit.lamps[size_t(lamp)].dial;
    const auto found = std::ranges::find(dial, order.light, &DialLight::spectrum);
    if (found == dial.end())
      return WireError{"unknown_light", "the lamp has no light '" + order.light + "'"};
    to = LampSwitch(2 + (found - dial.begin()));
  }
  switch_lamp(show, visitor, order.name, to);
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const HourOrder& order) {
  if (Answer wrong = check_not_following(show.visits, visitor)) return wrong;
  if (set_hour(show.stage, visitor, order.value)) return {};
  return WireError{"no_day", "the hour of the day cannot be chosen here"};
}

Answer handle_one(Show& show, Visitor& visitor, const PieceOrder& order) {
  if (Answer wrong = check_not_following(show.visits, visitor)) return wrong;
  const std::string wrong = choose_piece(show.stage.exhibit, order, visitor.pieces.wish);
  if (!wrong.empty()) return WireError{"unknown_piece", wrong};
  visitor.pieces.told_at = -1e9;  // who chooses sees it at once
  visitor.state_sent_at = -1e9;
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const LensOrder& order) {
  PieceChoices choices;
  const std::string wrong = look_through(show.stage.exhibit, order, choices);
  if (!wrong.empty()) return WireError{"unknown_piece", wrong};
  visitor.lens = order;
  visitor.lens_at = show.time;
  return {};
}

// Returns where two places lie in a scan, if both do.
std::optional<ScanPlaces> places_in_scan(const Exhibit& exhibit, const Pointed& from,
                                         const Pointed& to) {
  if (from.point < 0 || from.point != to.point) return {};
  const auto piece =
      std::ranges::find(exhibit.pieces, exhibit.points[size_t(from.point)].id, &ExhibitPiece::id);
  if (piece == exhibit.pieces.end() || !piece->is_scan()) return {};
  const glm::dmat4 back = glm::inverse(file_to_world(*piece));
  auto place_of = [&](const Pointed& one) {
    return dvec3(back * glm::dvec4(dvec3(one.place) + exhibit.scene.origin, 1));
  };
  return ScanPlaces{piece->id, place_of(from), place_of(to)};
}

Answer handle_one(Show& show, Visitor& visitor, const MeasureOrder& order) {
  const View& view = visitor.place.last_view;
  const Exhibit& exhibit = show.stage.exhibit;
  const auto from = point_at(exhibit, *show.stage.world, view, *order.from);
  const auto to = point_at(exhibit, *show.stage.world, view, *order.to);
  if (!from || !to) return WireError{"nothing_there", "nothing is seen there"};
  visitor.link->send_text(measured_message(order.id, double(glm::length(to->place - from->place)),
                                           places_in_scan(exhibit, *from, *to)));
  return {};
}

Answer handle_one(Show& show, Visitor& visitor, const PlayOrder& order) {
  if (Answer wrong = check_not_following(show.visits, visitor)) return wrong;
  if (play_animation(show, visitor, order.name, order.on)) return {};
  return WireError{"unknown_animation",
                   "there is no animation '" + order.name + "' that is started by touch"};
}

Answer handle_one(Show& show, Visitor& visitor, const StorytellerOrder& order) {
  return handle_storyteller(show, visitor, order);
}

Answer handle_one(Show& show, Visitor& visitor, const Ask& question) {
  return ask(show, visitor, question);
}

Answer handle_one(Show& show, Visitor& visitor, const GroupOrder& order) {
  return handle_group(show.visits, visitor, order);
}

Answer handle_one(Show&, Visitor& visitor, const KioskTouch&) {
  if (visitor.kiosk) return {};  // note_touch()
  return WireError{"no_kiosk", "only the page of a kiosk says what is done there"};
}

Answer handle_one(Show& show, Visitor& visitor, const Settings& settings) {
  PictureWishes& wants = visitor.wants;
  if (settings.fps) wants.fps = std::clamp(*settings.fps, 0.0f, 120.0f);
  if (settings.sound) visitor.hearing.wanted = *settings.sound;
  if (settings.comfort) visitor.place.comfort = *settings.comfort;
  if (settings.quality) wants.best_quality = *settings.quality;
  if (settings.max_quality) wants.still_quality = *settings.max_quality;
  wants.best_quality = std::min(wants.best_quality, wants.still_quality);
  if (settings.bandwidth) wants.bandwidth = 1000.0 / 8 * *settings.bandwidth;
  if (settings.saver) wants.saver = *settings.saver;
  if (!settings.display.empty()) set_display(show, visitor, settings.display);
  if (settings.attention) {
    const bool* on = std::get_if<bool>(&*settings.attention);
    wants.attention = !on || *on;
    if (!on) wants.task_weight = std::get<float>(*settings.attention);
  }
  Answer wrong;
  if (settings.width || settings.height)
    wrong = set_size(visitor, show.settings, settings.width.value_or(wants.width),
                     settings.height.value_or(wants.height));
  if (!settings.lang.empty() && settings.lang != visitor.lang) {
    visitor.lang = settings.lang;
    visitor.link->send_text(welcome_message(show, visitor));
  }
  return wrong;
}

Answer handle_one(Show& show, Visitor& visitor, const Ack& ack) {
  note_ack(visitor.shown.flow, ack.frame, ack.decoded_ms, show.time);
  if (!ack.shown) visitor.shown.lost = true;
  return {};
}

Answer handle_one(Show&, Visitor&, const PresenceNews&) {
  return {};  // note_presence()
}

Answer handle_one(Show&, Visitor& visitor, const Bye&) {
  visitor.left = true;
  return {};
}

// Returns whether the message is about the page that sends it, not about what is to be seen.
bool is_of_page(const BrowserMessage& message) {
  return std::visit(
      [](const auto& one) {
        using Message = std::decay_t<decltype(one)>;
        return std::is_same_v<Message, Hello> || std::is_same_v<Message, Settings> ||
               std::is_same_v<Message, Ack> || std::is_same_v<Message, PresenceNews> ||
               std::is_same_v<Message, Bye>;
      },
      message);
}

}  // namespace

std::optional<WireError> handle(Show& show, Visitor& visitor, const BrowserMessage& message) {
  bool may_speak = visitor.welcomed || std::holds_alternative<Hello>(message) ||
                   std::holds_alternative<Bye>(message);
  if (!may_speak) return WireError{"hello_first", "the first message must be hello"};
  note_presence(visitor, message);
  Visitor* camera = is_of_page(message) ? nullptr : camera_of(show.visits, visitor);
  Visitor& who = camera ? *camera : visitor;
  return std::visit([&](const auto& one) { return handle_one(show, who, one); }, message);
}

}  // namespace wellspring::show
