// SPDX-License-Identifier: Apache-2.0
// Writes messages as JSON text, and reads JSON text as a tree of values that stops at the limits.
#include "wire/json.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

namespace wellspring::wire {

// Writes messages of browsers and kiosks, and errors, as text: compact, "type" first.

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

static ordered_json to_json(const Expression& e) {
  return {{"joy", rounded(e.joy)},         {"sadness", rounded(e.sadness)},
          {"anger", rounded(e.anger)},     {"fear", rounded(e.fear)},
          {"disgust", rounded(e.disgust)}, {"surprise", rounded(e.surprise)}};
}

std::string write_observation(const Observation& observation) {
  ordered_json people = ordered_json::array();
  for (const Person& person : observation.people) {
    ordered_json item = {{"id", person.id},
                         {"position", rounded(person.position)},
                         {"rotation", rounded(person.rotation)},
                         {"confidence", rounded(person.confidence)}};
    if (person.expression) item["expression"] = to_json(*person.expression);
    if (!person.gesture.empty()) item["gesture"] = person.gesture;
    people.push_back(std::move(item));
  }
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
  if (observation.networks != EyeNetworks::all)
    message["networks"] = eye_networks[size_t(observation.networks)];
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

namespace {

// Writes the fields that a message lists.
class MessageWriter {
 public:
  explicit MessageWriter(const char* type) { out = {{"type", type}}; }
  ordered_json out;

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
    ordered_json numbers = ordered_json::array();
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

// Describes a browser's messages in words, from the lists of the messages' fields.

namespace {

// Notes the meaning of each field that a message lists.
struct MessageDescriber {
  json out = json::object();

  void text(const char* name, const std::string&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void token(const char* name, const std::string&, const char* about) { out[name] = about; }
  void word(const char* name, std::initializer_list<const char*>, const std::string&,
            const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void choice(const char* name, std::initializer_list<const char*>, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number(const char* name, double, double, const auto&, const char* about,
              Need = Need::optional) {
    out[name] = about;
  }
  void number_or_null(const char* name, double, double, const auto&, const char* about) {
    out[name] = about;
  }
  void integer(const char* name, int, int, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void u32(const char* name, uint32_t, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void boolean(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void switch_or_number(const char* name, double, double, const auto&, const char* about,
                        Need = Need::optional) {
    out[name] = about;
  }
  void place(const char* name, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void spot(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void vector(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
  void speed(const char* name, double, const auto&, const char* about, Need = Need::optional) {
    out[name] = about;
  }
};

template <class Message>
void describe(json& all) {
  const Message message;
  MessageDescriber describer;
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

namespace {

// Builds the tree from the parser's calls. The parser itself keeps its state in a vector, so depth
// costs no stack while parsing.
class TreeBuilder {
 public:
  TreeBuilder(std::string_view text, const JsonLimits& limits) : text_(text), limits_(limits) {}
  json root;
  WireError error;
  size_t values = 0;

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add(value); }
  bool number_unsigned(json::number_unsigned_t value) { return add(value); }
  bool number_float(json::number_float_t value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return fail("bad_json", "binary values are not JSON"); }
  bool start_object(size_t) { return open(json::object()); }
  bool start_array(size_t) { return open(json::array()); }
  bool end_object() { return shut(); }
  bool end_array() { return shut(); }
  bool key(std::string& name) {
    key_ = std::move(name);
    return true;
  }
  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& e) {
    if (e.id == 406)  // a number beyond double
      return fail("bad_field", "number out of range at " + place_of(position) +
                                   (key_.empty() ? "" : " (field '" + key_.substr(0, 64) + "')"));
    return fail("bad_json", "not JSON at " + place_of(position));
  }

 private:
  // Returns the place of the last character read, counted from 1; a column is a byte.
  std::string place_of(size_t position) const {
    std::string_view read = text_.substr(0, position > 0 ? position - 1 : 0);
    size_t line = 1 + size_t(std::count(read.begin(), read.end(), '\n'));
    size_t begin = read.rfind('\n') + 1;  // npos + 1 is 0
    return "line " + std::to_string(line) + ", column " + std::to_string(read.size() - begin + 1);
  }
  json* add(json&& value, json*& place) {
    if (open_.empty()) {
      root = std::move(value);
      place = &root;
    } else if (json& parent = *open_.back(); parent.is_array()) {
      parent.push_back(std::move(value));
      place = &parent.back();
    } else {
      place = &(parent[key_] = std::move(value));
    }
    return place;
  }
  bool add(json&& value) {
    json* place = nullptr;
    return count() && add(std::move(value), place) != nullptr;
  }
  bool count() {
    if (values >= limits_.values)
      return fail("too_large", "more than " + std::to_string(limits_.values) + " values");
    values++;
    return true;
  }
  // Opens a container. Addresses stay valid while it is open: a container only grows after its last
  // value was closed.
  bool open(json&& value) {
    if (int(open_.size()) >= limits_.depth)
      return fail("too_deep", "nested deeper than " + std::to_string(limits_.depth));
    if (!count()) return false;
    json* place = nullptr;
    open_.push_back(add(std::move(value), place));
    return true;
  }
  bool shut() {
    open_.pop_back();
    return true;
  }
  bool fail(std::string code, std::string message) {
    error = {std::move(code), std::move(message)};
    return false;
  }

  std::string_view text_;
  const JsonLimits limits_;
  std::string key_;
  std::vector<json*> open_;
};

}  // namespace

std::variant<json, WireError> parse_json(std::string_view text, const JsonLimits& limits,
                                         size_t* values) {
  TreeBuilder builder(text, limits);
  const bool good = json::sax_parse(text.begin(), text.end(), &builder);
  if (values) *values = builder.values;
  if (!good) return std::move(builder.error);
  return std::move(builder.root);
}

}  // namespace wellspring::wire
