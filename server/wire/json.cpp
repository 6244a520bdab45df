// SPDX-License-Identifier: Apache-2.0
// Writes messages as JSON text, and describes them.
#include "wire/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "json/fields.h"

namespace wellspring::wire {

using nlohmann::json;
using nlohmann::ordered_json;

// Dumps the text, and never throws on bad UTF-8, which strings of our own (file names) may hold.
static std::string to_text(const ordered_json& value) {
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

// Rounds to 4 decimals; adding 0 makes -0 a plain 0.
static double rounded(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }

static ordered_json rounded(vec3 v) {
  return ordered_json::array({rounded(v.x), rounded(v.y), rounded(v.z)});
}

static ordered_json rounded(vec2 v) { return ordered_json::array({rounded(v.x), rounded(v.y)}); }

static ordered_json to_json(const Expression& e) {
  ordered_json out = {{"joy", rounded(e.joy)},         {"sadness", rounded(e.sadness)},
                      {"anger", rounded(e.anger)},     {"fear", rounded(e.fear)},
                      {"disgust", rounded(e.disgust)}, {"surprise", rounded(e.surprise)}};
  if (e.valence) out["valence"] = rounded(*e.valence);
  if (e.arousal) out["arousal"] = rounded(*e.arousal);
  return out;
}

static ordered_json to_json(const Hand& hand) {
  ordered_json out = {{"position", rounded(hand.position)},
                      {"pose", hand_poses[size_t(hand.pose)]}};
  if (hand.fingers) out["fingers"] = *hand.fingers;
  if (hand.points_at) out["points_at"] = rounded(*hand.points_at);
  return out;
}

static ordered_json to_json(const Person& person) {
  ordered_json out = {{"id", person.id},
                      {"position", rounded(person.position)},
                      {"rotation", rounded(person.rotation)},
                      {"confidence", rounded(person.confidence)}};
  if (person.expression) out["expression"] = to_json(*person.expression);
  if (!person.gesture.empty()) out["gesture"] = person.gesture;
  if (person.liveness) out["liveness"] = rounded(*person.liveness);
  if (person.gaze) out["gaze"] = rounded(*person.gaze);
  if (person.lids) out["lids"] = rounded(*person.lids);
  if (person.mouth) out["mouth"] = rounded(*person.mouth);
  for (const Hand& hand : person.hands) out["hands"].push_back(to_json(hand));
  return out;
}

static ordered_json to_json(const Body& body) {
  ordered_json out = {{"id", body.id},
                      {"position", rounded(body.position)},
                      {"course", body_courses[size_t(body.course)]},
                      {"confidence", rounded(body.confidence)}};
  if (body.height > 0) out["height"] = rounded(body.height);
  if (body.seated) out["seated"] = true;
  if (body.raised_hand) out["raised_hand"] = true;
  return out;
}

static ordered_json to_json(const Holding& holding) {
  ordered_json out = ordered_json::object();
  if (!holding.id.empty()) out["id"] = holding.id;
  if (!holding.of_class.empty()) out["class"] = holding.of_class;
  if (!holding.title.empty()) out["title"] = holding.title;
  if (!holding.hint.empty()) out["hint"] = holding.hint;
  if (holding.position) out["position"] = rounded(*holding.position);
  if (holding.rotation) out["rotation"] = rounded(*holding.rotation);
  return out;
}

std::string write_observation(const Observation& observation) {
  ordered_json people = ordered_json::array();
  for (const Person& person : observation.people) people.push_back(to_json(person));
  ordered_json message = {{"type", "observation"},
                          {"time", rounded(observation.time)},
                          {"presence", observation.state == Presence::person},
                          {"state", to_string(observation.state)},
                          {"people", std::move(people)}};
  if (observation.camera != CameraState::good)
    message["camera_state"] = camera_states[size_t(observation.camera)];
  if (!observation.name.empty()) message["camera_name"] = observation.name;
  if (const auto& step = observation.calibration)
    message["calibration"] = {{"step", calibration_steps[size_t(step->what)]},
                              {"metres", rounded(step->metres)},
                              {"progress", rounded(step->progress)}};
  if (!observation.kiosk.empty()) message["kiosk"] = observation.kiosk;
  if (observation.parts != EyeParts{}) {
    FieldWriter parts;
    EyeParts::list(observation.parts, parts);
    message["eyes"] = std::move(parts.out);
  }
  if (observation.holding) message["holding"] = to_json(*observation.holding);
  for (const Body& body : observation.bodies) message["bodies"].push_back(to_json(body));
  return to_text(message);
}

std::string write_eye_order(const EyeOrder& order) {
  const EyeNeeds& needs = order.needs;
  ordered_json message = {
      {"type", "kiosk"},
      {"stage", order.stage},
      {"needs",
       {{"faces", needs.faces}, {"expression", needs.expression}, {"gestures", needs.gestures}}}};
  if (order.idle) message["idle"] = true;
  return to_text(message);
}

std::string write_waiting(const WaitingPlace& waiting) {
  ordered_json message = {{"type", "waiting"}, {"place", waiting.place}, {"of", waiting.of}};
  if (waiting.seconds) message["seconds"] = std::round(*waiting.seconds);
  return to_text(message);
}

std::string write_error(const WireError& error) {
  return to_text({{"type", "error"}, {"code", error.code}, {"message", error.message}});
}

std::string write_message(const BrowserMessage& message) {
  return std::visit(
      [](const auto& one) {
        FieldWriter writer;
        writer.out["type"] = one.type;
        one.list(one, writer);
        return to_text(writer.out);
      },
      message);
}

namespace {

template <class Message>
void describe(json& all) {
  const Message message;
  FieldDescriber describer;
  Message::list(message, describer);
  all[Message::type] = std::move(describer.out);
}

template <class... Messages>
void describe_all(const std::variant<Messages...>&, json& all) {
  (describe<Messages>(all), ...);
}

}  // namespace

json describe_browser_messages() {
  json all = json::object();
  describe_all(BrowserMessage{}, all);
  return all;
}

}  // namespace wellspring::wire
