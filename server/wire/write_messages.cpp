// SPDX-License-Identifier: Apache-2.0
// Messages of browsers and kiosks, and errors, into text: compact, "type" first.
#include <cmath>
#include <nlohmann/json.hpp>

#include "wire/json.h"

namespace wellspring {

using json = nlohmann::ordered_json;

// Never throws on bad UTF-8, which strings of our own (file names) may hold.
static std::string to_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Adding 0 makes -0 a plain 0.
static double rounded(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }

static json rounded(vec3 v) { return json::array({rounded(v.x), rounded(v.y), rounded(v.z)}); }

static json to_json(const Expression& e) {
  return {{"joy", rounded(e.joy)},         {"sadness", rounded(e.sadness)},
          {"anger", rounded(e.anger)},     {"fear", rounded(e.fear)},
          {"disgust", rounded(e.disgust)}, {"surprise", rounded(e.surprise)}};
}

std::string write_observation(const Observation& observation) {
  json people = json::array();
  for (const Person& person : observation.people) {
    json item = {{"id", person.id},
                 {"position", rounded(person.position)},
                 {"rotation", rounded(person.rotation)},
                 {"confidence", rounded(person.confidence)}};
    if (person.expression) item["expression"] = to_json(*person.expression);
    if (!person.gesture.empty()) item["gesture"] = person.gesture;
    people.push_back(std::move(item));
  }
  return to_text({{"type", "observation"},
                  {"time", rounded(observation.time)},
                  {"presence", observation.state == Presence::person},
                  {"state", to_string(observation.state)},
                  {"people", std::move(people)}});
}

std::string write_error(const WireError& error) {
  return to_text({{"type", "error"}, {"code", error.code}, {"message", error.message}});
}

static json to_json(const Hello& hello) {
  json out = {{"type", "hello"}, {"width", hello.width}, {"height", hello.height}};
  if (!hello.exhibit.empty()) out["exhibit"] = hello.exhibit;
  if (!hello.lang.empty()) out["lang"] = hello.lang;
  if (!hello.role.empty()) out["role"] = hello.role;
  if (!hello.kiosk.empty()) out["kiosk"] = hello.kiosk;
  return out;
}

static json to_json(const Input& input) {
  return {{"type", "input"},
          {"seq", input.seq},
          {"move", {input.move.x, input.move.y, input.move.z}},
          {"look", {input.look.x, input.look.y}}};
}

static json to_json(const CameraTo& camera) {
  return {{"type", "camera"},
          {"seq", camera.seq},
          {"position", {camera.position.x, camera.position.y, camera.position.z}},
          {"yaw", camera.yaw},
          {"pitch", camera.pitch}};
}

static json to_json(const ViewpointTo& viewpoint) {
  return {{"type", "viewpoint"}, {"seq", viewpoint.seq}, {"name", viewpoint.name}};
}

static json to_json(const Tour& tour) {
  const char* action = tour.action == TourAction::play    ? "play"
                       : tour.action == TourAction::pause ? "pause"
                                                          : "stop";
  json out = {{"type", "tour"}, {"action", action}};
  if (!tour.name.empty()) out["name"] = tour.name;
  return out;
}

static json to_json(const StorytellerOrder& order) {
  json out = {{"type", "storyteller"}};
  if (order.visible) out["visible"] = *order.visible;
  if (order.humanlike) out["humanlike"] = *order.humanlike;
  if (!order.teller.empty()) out["teller"] = order.teller;
  if (!order.story.empty()) out["story"] = order.story;
  if (!order.action.empty()) out["action"] = order.action;
  return out;
}

static json to_json(const LampOrder& order) {
  return {{"type", "lamp"}, {"name", order.name}, {"on", order.on}};
}

static json to_json(const Settings& settings) {
  json out = {{"type", "settings"}};
  if (settings.fps) out["fps"] = *settings.fps;
  if (settings.attention) out["attention"] = *settings.attention;
  if (settings.sound) out["sound"] = *settings.sound;
  if (settings.quality) out["quality"] = *settings.quality;
  if (settings.max_quality) out["max_quality"] = *settings.max_quality;
  if (settings.width) out["width"] = *settings.width;
  if (settings.height) out["height"] = *settings.height;
  if (!settings.lang.empty()) out["lang"] = settings.lang;
  return out;
}

static json to_json(const Ack& ack) {
  return {
      {"type", "ack"}, {"frame", ack.frame}, {"decoded_ms", ack.decoded_ms}, {"shown", ack.shown}};
}

static json to_json(const Bye&) { return {{"type", "bye"}}; }

std::string write_message(const BrowserMessage& message) {
  return std::visit([](const auto& m) { return to_text(to_json(m)); }, message);
}

}  // namespace wellspring
