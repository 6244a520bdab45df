// SPDX-License-Identifier: Apache-2.0
// Messages of browsers and kiosks, and errors, into text: compact, "type" first.
#include <cmath>
#include <nlohmann/json.hpp>

#include "wire/json.h"

namespace wellspring::wire {

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
  json message = {{"type", "observation"},
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
  if (observation.networks != EyeNetworks::all)
    message["networks"] = eye_networks[size_t(observation.networks)];
  return to_text(message);
}

std::string write_eye_order(const EyeOrder& order) {
  const EyeNeeds& needs = order.needs;
  json message = {
      {"type", "kiosk"},
      {"stage", order.stage},
      {"needs",
       {{"faces", needs.faces}, {"expression", needs.expression}, {"gestures", needs.gestures}}}};
  if (order.idle) message["idle"] = true;
  return to_text(message);
}

std::string write_waiting(const WaitingPlace& waiting) {
  json message = {{"type", "waiting"}, {"place", waiting.place}, {"of", waiting.of}};
  if (waiting.seconds) message["seconds"] = std::round(*waiting.seconds);
  return to_text(message);
}

std::string write_error(const WireError& error) {
  return to_text({{"type", "error"}, {"code", error.code}, {"message", error.message}});
}

namespace {

// Writes the fields that a message lists.
class MessageWriter {
 public:
  explicit MessageWriter(const char* type) { out = {{"type", type}}; }
  json out;

  void token(const char* name, const std::string& value, const char* about) {
    text(name, value, about);
  }
  void text(const char* name, const std::string& value, const char*, Need need = Need::optional) {
    if (need == Need::required || !value.empty()) out[name] = value;
  }
  void word(const char* name, std::initializer_list<const char*>, const std::string& value,
            const char* about, Need need = Need::optional) {
    text(name, value, about, need);
  }
  template <class Choice>
  void choice(const char* name, std::initializer_list<const char*> words, Choice value, const char*,
              Need = Need::optional) {
    out[name] = words.begin()[size_t(value)];
  }
  template <class Value>
  void number(const char* name, double, double, const Value& value, const char*,
              Need = Need::optional) {
    put(name, value);
  }
  void number_or_null(const char* name, double, double, const std::optional<double>& value,
                      const char*) {
    put(name, value);
  }
  template <class Value>
  void integer(const char* name, int, int, const Value& value, const char*, Need = Need::optional) {
    put(name, value);
  }
  void u32(const char* name, uint32_t value, const char*, Need = Need::optional) {
    put(name, value);
  }
  template <class Value>
  void boolean(const char* name, const Value& value, const char*, Need = Need::optional) {
    put(name, value);
  }
  void switch_or_number(const char* name, double, double,
                        const std::optional<std::variant<bool, float>>& value, const char*,
                        Need = Need::optional) {
    if (value) std::visit([&](auto one) { out[name] = one; }, *value);
  }
  void place(const char* name, const std::optional<vec2>& value, const char* about,
             Need need = Need::optional) {
    if (value) vector(name, 1, *value, about, need);
  }
  void spot(const char* name, double limit, const std::optional<dvec3>& value, const char* about,
            Need need = Need::optional) {
    if (value) vector(name, limit, *value, about, need);
  }
  template <class Vector>
  void vector(const char* name, double, const Vector& value, const char*, Need = Need::optional) {
    json numbers = json::array();
    for (int i = 0; i < value.length(); i++) numbers.push_back(value[i]);
    out[name] = std::move(numbers);
  }
  void speed(const char* name, double limit, const vec3& value, const char* about,
             Need need = Need::optional) {
    vector(name, limit, value, about, need);
  }

 private:
  template <class Value>
  void put(const char* name, const Value& value) {
    out[name] = value;
  }
  template <class Value>
  void put(const char* name, const std::optional<Value>& value) {
    if (value) out[name] = *value;
  }
};

}  // namespace

std::string write_message(const BrowserMessage& message) {
  return std::visit(
      [](const auto& one) {
        MessageWriter writer(one.type);
        one.list(one, writer);
        return to_text(writer.out);
      },
      message);
}

}  // namespace wellspring::wire
