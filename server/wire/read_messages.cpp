// SPDX-License-Identifier: Apache-2.0
// Reads messages of browsers and kiosks from text.
#include "wire/read_messages.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wellspring::wire {

using nlohmann::json;

static std::string short_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%.10g", value);
  return buffer;
}

static bool has_control_character(std::string_view text) {
  for (const unsigned char c : text)
    if (c < 0x20 || c == 0x7f) return true;
  return false;
}

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

Fields::Fields(const json& object, std::string prefix, std::optional<WireError>& error)
    : object_(object), prefix_(std::move(prefix)), error_(error) {
  if (!error_ && !object.is_object()) fail("", "must be an object");
}

void Fields::fail(const std::string& name, const std::string& what) {
  if (error_) return;
  std::string full = prefix_ + name;
  if (name.empty() && full.ends_with('.')) full.pop_back();
  error_ = WireError{"bad_field", full + " " + what};
}

const json* Fields::find(const char* name, Need need) {
  if (error_) return nullptr;
  const auto found = object_.find(name);
  if (found != object_.end()) return &*found;
  if (need == Need::required) fail(name, "is missing");
  return nullptr;
}

bool Fields::is_null(const char* name) const {
  const auto found = object_.find(name);
  return found != object_.end() && found->is_null();
}

bool Fields::check_number(const std::string& name, const json& value, double low, double high,
                          double& out) {
  if (!value.is_number()) return fail(name, "must be a number"), false;
  const double number = value.get<double>();
  if (!std::isfinite(number) || number < low || number > high)
    return fail(name, "must be from " + short_number(low) + " to " + short_number(high)), false;
  out = number;
  return true;
}

bool Fields::number(const char* name, double low, double high, double& value, Need need) {
  const json* field = find(name, need);
  return field && check_number(name, *field, low, high, value);
}

bool Fields::number(const char* name, double low, double high, float& value, Need need) {
  double number = 0;
  if (!this->number(name, low, high, number, need)) return false;
  value = float(number);
  return true;
}

bool Fields::whole(const char* name, double low, double high, double& value, Need need) {
  double number = 0;
  if (!this->number(name, low, high, number, need)) return false;
  if (number != std::floor(number)) return fail(name, "must be a whole number"), false;
  value = number;
  return true;
}

bool Fields::u32(const char* name, uint32_t& value, Need need) {
  double number = 0;
  if (!whole(name, 0, 4294967295.0, number, need)) return false;
  value = uint32_t(number);
  return true;
}

bool Fields::integer(const char* name, int low, int high, int& value, Need need) {
  double number = 0;
  if (!whole(name, low, high, number, need)) return false;
  value = int(number);
  return true;
}

bool Fields::boolean(const char* name, bool& value, Need need) {
  const json* field = find(name, need);
  if (!field) return false;
  if (!field->is_boolean()) return fail(name, "must be true or false"), false;
  value = field->get<bool>();
  return true;
}

bool Fields::switch_or_number(const char* name, double low, double high,
                              std::optional<std::variant<bool, float>>& value, Need need) {
  const json* field = find(name, need);
  if (!field) return false;
  double number = 0;
  if (field->is_boolean()) value = field->get<bool>();
  else if (!field->is_number()) return fail(name, "must be true, false or a number"), false;
  else if (!check_number(name, *field, low, high, number)) return false;
  else value = float(number);
  return true;
}

bool Fields::text(const char* name, std::string& value, Need need, size_t most_bytes) {
  const json* field = find(name, need);
  if (!field) return false;
  if (!field->is_string()) return fail(name, "must be a string"), false;
  const auto& text = field->get_ref<const std::string&>();
  if (text.size() > most_bytes)
    return fail(name, "must be at most " + std::to_string(most_bytes) + " bytes"), false;
  if (has_control_character(text)) return fail(name, "must have no control characters"), false;
  if (need == Need::required && text.empty()) return fail(name, "must not be empty"), false;
  value = text;
  return true;
}

bool Fields::word(const char* name, std::initializer_list<const char*> words, std::string& value,
                  Need need) {
  std::string text;
  if (!this->text(name, text, need)) return false;
  bool known = text.empty();  // a required one is never empty here
  std::string list;
  for (const char* word : words) {
    known = known || text == word;
    list += (list.empty() ? "" : ", ") + std::string(word);
  }
  if (!known) return fail(name, "must be one of " + list), false;
  value = text;
  return true;
}

bool Fields::numbers(const char* name, int count, double limit, double* values, Need need) {
  const json* field = find(name, need);
  if (!field) return false;
  if (!field->is_array() || int(field->size()) != count)
    return fail(name, "must be an array of " + std::to_string(count) + " numbers"), false;
  for (int i = 0; i < count; i++)
    if (!check_number(std::string(name) + "[" + std::to_string(i) + "]", (*field)[size_t(i)],
                      -limit, limit, values[i]))
      return false;
  return true;
}

bool Fields::vector(const char* name, double limit, vec2& value, Need need) {
  dvec2 v{0};
  if (!numbers(name, 2, limit, &v.x, need)) return false;
  value = vec2(v);
  return true;
}

bool Fields::vector(const char* name, double limit, vec3& value, Need need) {
  dvec3 v{0};
  if (!vector(name, limit, v, need)) return false;
  value = vec3(v);
  return true;
}

bool Fields::vector(const char* name, double limit, dvec3& value, Need need) {
  double v[3];
  if (!numbers(name, 3, limit, v, need)) return false;
  value = {v[0], v[1], v[2]};
  return true;
}

const json* Fields::object(const char* name) {
  const json* field = find(name, Need::optional);
  if (!field) return nullptr;
  if (!field->is_object()) return fail(name, "must be an object"), nullptr;
  return field;
}

const json* Fields::array(const char* name, size_t max_size) {
  const json* field = find(name, Need::optional);
  if (!field) return nullptr;
  if (!field->is_array()) return fail(name, "must be an array"), nullptr;
  if (field->size() > max_size)
    return fail(name, "must have at most " + std::to_string(max_size) + " items"), nullptr;
  return field;
}

WireError too_large(size_t most_bytes) {
  return {"too_large", "message of more than " + std::to_string(most_bytes) + " bytes"};
}

std::variant<Envelope, WireError> open_envelope(std::string_view text, const EnvelopeLimits& limits,
                                                size_t* values) {
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

using nlohmann::json;

namespace {

// Takes the fields that a message lists out of an object; each function reads one kind of field.
// Absent fields keep the message's defaults.
class MessageReader {
 public:
  explicit MessageReader(Fields& fields) : fields_(fields) {}

  void text(const char* name, std::string& value, const char*, Need need = Need::optional) {
    fields_.text(name, value, need);
  }
  // A text that this server sealed before (wire/tokens.h).
  void token(const char* name, std::string& value, const char*) {
    fields_.text(name, value, Need::optional, max_token_bytes);
  }
  // One of `words`, or empty.
  void word(const char* name, std::initializer_list<const char*> words, std::string& value,
            const char*, Need need = Need::optional) {
    fields_.word(name, words, value, need);
  }
  // One of `words`, which name the values of an enumeration in order.
  template <class Choice>
  void choice(const char* name, std::initializer_list<const char*> words, Choice& value,
              const char*, Need need = Need::optional) {
    std::string word;
    if (!fields_.word(name, words, word, need)) return;
    const auto found = std::ranges::find(words, word);
    if (found != words.end()) value = Choice(found - words.begin());
  }
  template <class Value>
  void number(const char* name, double low, double high, Value& value, const char*,
              Need need = Need::optional) {
    read(value, [&](auto& v) { return fields_.number(name, low, high, v, need); });
  }
  // A number; null counts as absent.
  void number_or_null(const char* name, double low, double high, std::optional<double>& value,
                      const char* about) {
    if (!fields_.is_null(name)) number(name, low, high, value, about);
  }
  template <class Value>
  void integer(const char* name, int low, int high, Value& value, const char*,
               Need need = Need::optional) {
    read(value, [&](int& v) { return fields_.integer(name, low, high, v, need); });
  }
  void u32(const char* name, uint32_t& value, const char*, Need need = Need::optional) {
    fields_.u32(name, value, need);
  }
  template <class Value>
  void boolean(const char* name, Value& value, const char*, Need need = Need::optional) {
    read(value, [&](bool& v) { return fields_.boolean(name, v, need); });
  }
  // True or false, or a number.
  void switch_or_number(const char* name, double low, double high,
                        std::optional<std::variant<bool, float>>& value, const char*,
                        Need need = Need::optional) {
    fields_.switch_or_number(name, low, high, value, need);
  }
  // Each of its numbers is at most `limit`, of either sign.
  template <class Vector>
  void vector(const char* name, double limit, Vector& value, const char*,
              Need need = Need::optional) {
    fields_.vector(name, limit, value, need);
  }
  // A place in a picture: both numbers from 0 to 1.
  void place(const char* name, std::optional<vec2>& value, const char*,
             Need need = Need::optional) {
    vec2 place{0};
    if (!fields_.vector(name, 1, place, need)) return;
    if (place.x < 0 || place.y < 0) return fields_.fail(name, "must be of numbers from 0 to 1");
    value = place;
  }
  // A place in the world: each number at most `limit`, of either sign.
  void spot(const char* name, double limit, std::optional<dvec3>& value, const char*,
            Need need = Need::optional) {
    dvec3 place{0};
    if (fields_.vector(name, limit, place, need)) value = place;
  }
  // A speed in metres a second: its length is at most `limit`, too.
  void speed(const char* name, double limit, vec3& value, const char*, Need need = Need::optional) {
    dvec3 speed{0};
    if (!fields_.vector(name, limit, speed, need)) return;
    if (glm::length(speed) > limit)
      fields_.fail(name, "must be at most " + std::to_string(int(limit)) + " m/s long");
    value = vec3(speed);
  }

 private:
  template <class Value, class Read>
  void read(Value& value, const Read& read) {
    read(value);
  }
  template <class Value, class Read>
  void read(std::optional<Value>& value, const Read& read) {
    Value found{};
    if (read(found)) value = found;
  }
  Fields& fields_;
};

template <class Message>
bool read_if(const std::string& type, Fields& fields, BrowserMessage& message) {
  if (type != Message::type) return false;
  Message read;
  MessageReader reader(fields);
  Message::list(read, reader);
  message = std::move(read);
  return true;
}

// Reads the message of that type; false: there is none.
template <class... Messages>
bool read_one_of(const std::string& type, Fields& fields, std::variant<Messages...>& message) {
  return (read_if<Messages>(type, fields, message) || ...);
}

}  // namespace

std::variant<BrowserMessage, WireError> read_browser_message(std::string_view text,
                                                             size_t* values) {
  auto opened = open_envelope(text, {max_hello_bytes, max_order_values}, values);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != Hello::type && text.size() > max_order_bytes) return too_large(max_order_bytes);
  std::optional<WireError> error;
  Fields fields(object, type + ".", error);
  BrowserMessage message;
  if (!read_one_of(type, fields, message))
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

static CalibrationStep read_calibration(const json& object, std::optional<WireError>& error) {
  CalibrationStep calibration;
  Fields fields(object, "observation.calibration.", error);
  std::string what = calibration_steps[0];
  fields.word("step", {"near", "far", "done", "failed"}, what, Need::required);
  calibration.what = CalibrationStep::What(std::ranges::find(calibration_steps, what) -
                                           std::begin(calibration_steps));
  fields.number("metres", 0, max_mark, calibration.metres);
  fields.number("progress", 0, 1, calibration.progress);
  return calibration;
}

std::variant<Observation, WireError> read_observation(std::string_view text, size_t* values) {
  auto opened = open_envelope(text, {}, values);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != "observation") return WireError{"unknown_type", "unknown type " + short_quote(type)};

  std::optional<WireError> error;
  Fields fields(object, "observation.", error);
  Observation observation;
  bool present = false;
  std::string state, camera = "good", networks = "all";
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
  fields.word("camera_state", {"good", "dark", "frozen", "missing", "slow"}, camera,
              Need::optional);
  observation.camera =
      CameraState(std::ranges::find(camera_states, camera) - std::begin(camera_states));
  fields.text("camera_name", observation.name);
  if (const json* calibration = fields.object("calibration"))
    observation.calibration = read_calibration(*calibration, error);
  fields.text("kiosk", observation.kiosk);
  fields.word("networks", {"all", "no_expression", "none"}, networks, Need::optional);
  observation.networks =
      EyeNetworks(std::ranges::find(eye_networks, networks) - std::begin(eye_networks));
  if (error) return std::move(*error);

  const auto distance = [](const Person& person) { return glm::length(person.position); };
  std::ranges::stable_sort(observation.people, {}, distance);
  return observation;
}

std::variant<EyeOrder, WireError> read_eye_order(std::string_view text) {
  auto opened = open_envelope(text);
  if (auto* error = std::get_if<WireError>(&opened)) return std::move(*error);
  const auto& [object, type] = std::get<Envelope>(opened);
  if (type != "kiosk") return WireError{"unknown_type", "unknown type " + short_quote(type)};

  std::optional<WireError> error;
  Fields fields(object, "kiosk.", error);
  EyeOrder order;
  fields.word("stage", {"sleep", "awake", "person", "engaged", "farewell"}, order.stage,
              Need::required);
  if (const json* needs = fields.object("needs")) {
    Fields of(*needs, "kiosk.needs.", error);
    of.boolean("faces", order.needs.faces);
    of.boolean("expression", order.needs.expression);
    of.boolean("gestures", order.needs.gestures);
  }
  fields.boolean("idle", order.idle);
  if (error) return std::move(*error);
  return order;
}

}  // namespace wellspring::wire
