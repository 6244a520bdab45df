// SPDX-License-Identifier: Apache-2.0
// Reads messages of browsers and kiosks from text.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "json/fields.h"
#include "wire/json.h"
#include "wire/limits.h"

namespace wellspring::wire {

using nlohmann::json;

namespace {

// Quotes a piece of a stranger's text for a message of ours: short, no control characters.
std::string short_quote(std::string_view text) {
  constexpr size_t longest = 40;
  const bool cut = text.size() > longest;
  size_t end = cut ? longest : text.size();
  while (cut && end > 0 && (text[end] & 0xc0) == 0x80) end--;  // not inside a UTF-8 character
  std::string out = "'";
  for (const char c : text.substr(0, end))
    out += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? '?' : c;
  return out + (cut ? "...'" : "'");
}

// Holds the object of a message whose size, syntax, depth and count of values are good and which
// has a "type" of type string.
struct Envelope {
  json object;
  std::string type;
};
struct EnvelopeLimits {
  size_t bytes = max_message_bytes, values = max_observation_values;
};

WireError too_large(size_t most_bytes) {
  return {"too_large", "message of more than " + std::to_string(most_bytes) + " bytes"};
}

std::variant<Envelope, WireError> open_envelope(std::string_view text,
                                                const EnvelopeLimits& limits = {},
                                                size_t* values = nullptr) {
  if (text.size() > limits.bytes) return too_large(limits.bytes);
  auto parsed = parse_json(text, {.values = limits.values}, values);
  if (auto* error = std::get_if<WireError>(&parsed)) return std::move(*error);
  Envelope envelope{std::move(std::get<json>(parsed)), {}};
  if (!envelope.object.is_object()) return WireError{"bad_json", "a message must be an object"};
  const auto type = envelope.object.find("type");
  if (type == envelope.object.end()) return WireError{"unknown_type", "type is missing"};
  if (!type->is_string()) return WireError{"unknown_type", "type must be a string"};
  envelope.type = type->get<std::string>();
  return envelope;
}

// Returns a fault in the words of messages: "observation.people[2].id is missing".
WireError bad_field(const std::string& type, const Fault& fault) {
  std::string full = type;
  for (size_t begin = 0; begin < fault.where.size();) {
    const size_t end = std::min(fault.where.find('/', begin + 1), fault.where.size());
    const std::string part = fault.where.substr(begin + 1, end - begin - 1);
    const bool index = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
    full += index ? "[" + part + "]" : "." + part;
    begin = end;
  }
  return {"bad_field", full + " " + fault.what};
}

template <class Message>
bool read_if(const std::string& type, FieldReader& fields, BrowserMessage& message) {
  if (type != Message::type) return false;
  Message read;
  Message::list(read, fields);
  message = std::move(read);
  return true;
}

// Reads the message of that type; false: there is none.
template <class... Messages>
bool read_one_of(const std::string& type, FieldReader& fields, std::variant<Messages...>& message) {
  return (read_if<Messages>(type, fields, message) || ...);
}

}  // namespace

std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text,
                                                             size_t* values) {
  auto opened = open_envelope(text, {max_hello_bytes, max_order_values}, values);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != Hello::type && text.size() > max_order_bytes) return too_large(max_order_bytes);
  Faults faults;
  FieldReader fields(object, faults);
  BrowserMessage message;
  if (!read_one_of(type, fields, message))
    return WireError{"unknown_type", "unknown type " + short_quote(type)};
  if (faults.first) return bad_field(type, *faults.first);
  return message;
}

namespace {

Expression read_expression(FieldReader& fields) {
  Expression expression;
  fields.number("joy", 0, 1, expression.joy);
  fields.number("sadness", 0, 1, expression.sadness);
  fields.number("anger", 0, 1, expression.anger);
  fields.number("fear", 0, 1, expression.fear);
  fields.number("disgust", 0, 1, expression.disgust);
  fields.number("surprise", 0, 1, expression.surprise);
  fields.number("valence", -1, 1, expression.valence);
  fields.number("arousal", -1, 1, expression.arousal);
  return expression;
}

// Reads a place on the screen's plane.
std::optional<vec2> read_on_screen(FieldReader& fields, const char* name) {
  vec2 place{0};
  return fields.vector(name, max_kiosk_distance, place) ? std::optional(place) : std::nullopt;
}

Hand read_hand(FieldReader& fields) {
  Hand hand;
  fields.vector("position", max_kiosk_distance, hand.position, "", Need::required);
  fields.choice("pose", {"other", "open", "fist", "pinch", "point"}, hand.pose, "", Need::required);
  fields.integer("fingers", 0, 5, hand.fingers);
  hand.points_at = read_on_screen(fields, "points_at");
  return hand;
}

Body read_body(FieldReader& fields) {
  Body body;
  fields.u32("id", body.id, "", Need::required);
  fields.vector("position", max_kiosk_distance, body.position, "", Need::required);
  fields.choice("course", {"stays", "comes", "leaves", "passes"}, body.course, "", Need::required);
  fields.number("confidence", 0, 1, body.confidence, "", Need::required);
  fields.number("height", 0, 3, body.height);
  fields.boolean("seated", body.seated);
  fields.boolean("raised_hand", body.raised_hand);
  return body;
}

Person read_person(FieldReader& fields) {
  Person person;
  fields.u32("id", person.id, "", Need::required);
  fields.vector("position", max_kiosk_distance, person.position, "", Need::required);
  fields.vector("rotation", max_angle, person.rotation, "", Need::required);
  fields.number("confidence", 0, 1, person.confidence, "", Need::required);
  fields.text("gesture", person.gesture);
  fields.part("expression", "",
              [&](FieldReader& part) { person.expression = read_expression(part); });
  fields.number("liveness", 0, 1, person.liveness);
  person.gaze = read_on_screen(fields, "gaze");
  fields.number("lids", 0, 1, person.lids);
  fields.number("mouth", 0, 1, person.mouth);
  fields.parts("hands", 2, "", [&](FieldReader& hand) { person.hands.push_back(read_hand(hand)); });
  return person;
}

std::map<std::string, std::string> read_by_language(FieldReader& fields, const char* name) {
  std::map<std::string, std::string> out;
  const auto texts = fields.take(name);
  if (!texts || !texts->object()) return out;
  const auto members = FieldReader(*texts).members();
  if (members.size() > max_languages) texts->fail("has too many languages");
  else
    for (const auto& [language, text] : members)
      if (language.empty() || language.size() > max_language) text.fail("is of no language");
      else text.text(out[language], max_text_bytes, Need::required);
  return out;
}

Holding read_holding(FieldReader& fields) {
  Holding holding;
  fields.text("id", holding.id);
  fields.text("class", holding.of_class);
  holding.title = read_by_language(fields, "title");
  holding.hint = read_by_language(fields, "hint");
  vec3 place{0}, rotation{0};
  if (fields.vector("position", max_kiosk_distance, place)) holding.position = place;
  if (fields.vector("rotation", max_angle, rotation)) holding.rotation = rotation;
  if (holding.id.empty() && holding.of_class.empty()) fields.fail("has neither id nor class");
  return holding;
}

CalibrationStep read_calibration(FieldReader& fields) {
  CalibrationStep calibration;
  fields.choice("step", {"near", "far", "done", "failed"}, calibration.what, "", Need::required);
  fields.number("metres", 0, max_mark, calibration.metres);
  fields.number("progress", 0, 1, calibration.progress);
  return calibration;
}

}  // namespace

std::variant<Observation, WireError> read_observation(std::string_view text, size_t* values) {
  auto opened = open_envelope(text, {}, values);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != "observation") return WireError{"unknown_type", "unknown type " + short_quote(type)};

  Faults faults;
  FieldReader fields(object, faults);
  Observation observation;
  bool present = false;
  fields.number("time", -max_time, max_time, observation.time, "", Need::required);
  const bool has_presence = fields.boolean("presence", present);
  observation.state = present ? Presence::person : Presence::absent;
  fields.choice("state", {"absent", "motion", "person"}, observation.state, "",
                has_presence ? Need::optional : Need::required);
  fields.parts("people", max_people, "",
               [&](FieldReader& person) { observation.people.push_back(read_person(person)); });
  fields.choice("camera_state", {"good", "dark", "frozen", "missing", "slow"}, observation.camera,
                "");
  fields.text("camera_name", observation.name);
  fields.part("calibration", "",
              [&](FieldReader& step) { observation.calibration = read_calibration(step); });
  fields.text("kiosk", observation.kiosk);
  fields.part("eyes", "", [&](FieldReader& part) {
    observation.parts.faces.reset();
    EyeParts::list(observation.parts, part);
  });
  fields.part("holding", "", [&](FieldReader& part) { observation.holding = read_holding(part); });
  fields.parts("bodies", max_people, "",
               [&](FieldReader& body) { observation.bodies.push_back(read_body(body)); });
  if (faults.first) return bad_field(type, *faults.first);

  const auto distance = [](const auto& one) { return glm::length(one.position); };
  std::ranges::stable_sort(observation.people, {}, distance);
  std::ranges::stable_sort(observation.bodies, {}, distance);
  return observation;
}

std::variant<EyeOrder, WireError> read_eye_order(std::string_view text) {
  auto opened = open_envelope(text);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != "kiosk") return WireError{"unknown_type", "unknown type " + short_quote(type)};

  Faults faults;
  FieldReader fields(object, faults);
  EyeOrder order;
  fields.word("stage", {"sleep", "awake", "person", "engaged", "farewell"}, order.stage, "",
              Need::required);
  fields.part("needs", "", [&](FieldReader& needs) {
    needs.boolean("faces", order.needs.faces);
    needs.boolean("expression", order.needs.expression);
    needs.boolean("gestures", order.needs.gestures);
  });
  fields.boolean("idle", order.idle);
  if (faults.first) return bad_field(type, *faults.first);
  return order;
}

}  // namespace wellspring::wire
