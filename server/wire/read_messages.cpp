// SPDX-License-Identifier: Apache-2.0
// Messages of browsers and kiosks, out of text.
#include <algorithm>

#include "wire/fields.h"

namespace wellspring {

using nlohmann::json;

static Hello read_hello(Fields& fields) {
  Hello hello;
  fields.text("exhibit", hello.exhibit);
  fields.text("lang", hello.lang);
  fields.text("kiosk", hello.kiosk);
  fields.word("role", {"visitor", "kiosk"}, hello.role);
  fields.integer("width", min_side, max_side, hello.width);
  fields.integer("height", min_side, max_side, hello.height);
  return hello;
}

static Input read_input(Fields& fields) {
  Input input;
  dvec3 move{0};
  fields.u32("seq", input.seq, Need::required);
  fields.vector("look", max_angle, input.look);
  fields.vector("move", max_speed, move);
  if (glm::length(move) > max_speed) fields.fail("move", "must be at most 20 m/s long");
  input.move = vec3(move);
  return input;
}

static CameraTo read_camera(Fields& fields) {
  CameraTo camera;
  fields.u32("seq", camera.seq, Need::required);
  fields.vector("position", max_coordinate, camera.position, Need::required);
  fields.number("yaw", -max_angle, max_angle, camera.yaw);
  fields.number("pitch", -max_angle, max_angle, camera.pitch);
  return camera;
}

static ViewpointTo read_viewpoint(Fields& fields) {
  ViewpointTo viewpoint;
  fields.u32("seq", viewpoint.seq, Need::required);
  fields.text("name", viewpoint.name, Need::required);
  return viewpoint;
}

static Tour read_tour(Fields& fields) {
  Tour tour;
  std::string action;
  fields.word("action", {"play", "pause", "stop"}, action, Need::required);
  if (action == "pause") tour.action = TourAction::pause;
  if (action == "stop") tour.action = TourAction::stop;
  fields.text("name", tour.name);
  return tour;
}

static StorytellerOrder read_storyteller(Fields& fields) {
  StorytellerOrder order;
  fields.maybe(order.visible, [&](bool& value) { return fields.boolean("visible", value); });
  fields.maybe(order.humanlike, [&](bool& value) { return fields.boolean("humanlike", value); });
  fields.text("teller", order.teller);
  fields.text("story", order.story);
  fields.word("action", {"play", "pause", "stop", "restart", "skip"}, order.action);
  return order;
}

static LampOrder read_lamp(Fields& fields) {
  LampOrder order;
  fields.text("name", order.name, Need::required);
  fields.boolean("on", order.on, Need::required);
  return order;
}

static Settings read_settings(Fields& fields) {
  Settings settings;
  const auto integer = [&](const char* name, int low, int high) {
    return [&fields, name, low, high](int& v) { return fields.integer(name, low, high, v); };
  };
  fields.maybe(settings.fps, [&](float& v) { return fields.number("fps", min_fps, max_fps, v); });
  fields.maybe(settings.attention, [&](bool& v) { return fields.boolean("attention", v); });
  fields.maybe(settings.sound, [&](bool& v) { return fields.boolean("sound", v); });
  fields.maybe(settings.quality, integer("quality", min_jpeg_quality, max_jpeg_quality));
  fields.maybe(settings.max_quality, integer("max_quality", min_jpeg_quality, max_jpeg_quality));
  fields.maybe(settings.width, integer("width", min_side, max_side));
  fields.maybe(settings.height, integer("height", min_side, max_side));
  fields.text("lang", settings.lang);
  return settings;
}

static Ack read_ack(Fields& fields) {
  Ack ack;
  fields.u32("frame", ack.frame, Need::required);
  fields.number("decoded_ms", 0, max_decoded_ms, ack.decoded_ms);
  fields.boolean("shown", ack.shown);
  return ack;
}

std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text) {
  auto opened = open_envelope(text);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  std::optional<WireError> error;
  Fields fields(object, type + ".", error);
  BrowserMessage message;
  if (type == "hello")
    message = read_hello(fields);
  else if (type == "input")
    message = read_input(fields);
  else if (type == "camera")
    message = read_camera(fields);
  else if (type == "viewpoint")
    message = read_viewpoint(fields);
  else if (type == "tour")
    message = read_tour(fields);
  else if (type == "storyteller")
    message = read_storyteller(fields);
  else if (type == "lamp")
    message = read_lamp(fields);
  else if (type == "settings")
    message = read_settings(fields);
  else if (type == "ack")
    message = read_ack(fields);
  else if (type == "bye")
    message = Bye{};
  else
    return WireError{"unknown_type", "unknown type " + short_quote(type)};
  if (error) return std::move(*error);
  return message;
}

static Expression read_expression(const json& object, const std::string& prefix,
                                  std::optional<WireError>& error) {
  Expression expression;
  Fields fields(object, prefix, error);
  fields.number("joy", 0, 1, expression.joy);
  fields.number("sadness", 0, 1, expression.sadness);
  fields.number("anger", 0, 1, expression.anger);
  fields.number("fear", 0, 1, expression.fear);
  fields.number("disgust", 0, 1, expression.disgust);
  fields.number("surprise", 0, 1, expression.surprise);
  return expression;
}

static Person read_person(const json& object, const std::string& prefix,
                          std::optional<WireError>& error) {
  Person person;
  Fields fields(object, prefix, error);
  fields.u32("id", person.id, Need::required);
  fields.vector("position", max_kiosk_distance, person.position, Need::required);
  fields.vector("rotation", max_angle, person.rotation, Need::required);
  fields.number("confidence", 0, 1, person.confidence, Need::required);
  fields.text("gesture", person.gesture);
  if (const json* expression = fields.object("expression"))
    person.expression = read_expression(*expression, prefix + "expression.", error);
  return person;
}

std::variant<Observation, WireError> read_observation(std::string_view text) {
  auto opened = open_envelope(text);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != "observation") return WireError{"unknown_type", "unknown type " + short_quote(type)};

  std::optional<WireError> error;
  Fields fields(object, "observation.", error);
  Observation observation;
  bool present = false;
  std::string state;
  fields.number("time", -max_time, max_time, observation.time, Need::required);
  const bool has_presence = fields.boolean("presence", present);
  fields.word("state", {"absent", "motion", "person"}, state,
              has_presence ? Need::optional : Need::required);
  if (state.empty()) state = present ? "person" : "absent";
  if (state == "motion") observation.state = Presence::motion;
  if (state == "person") observation.state = Presence::person;
  if (const json* people = fields.array("people", max_people))
    for (size_t i = 0; i < people->size() && !error; i++)
      observation.people.push_back(
          read_person((*people)[i], "observation.people[" + std::to_string(i) + "].", error));
  if (error) return std::move(*error);

  const auto distance = [](const Person& person) { return glm::length(person.position); };
  std::ranges::stable_sort(observation.people, {}, distance);
  return observation;
}

}  // namespace wellspring
