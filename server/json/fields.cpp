// SPDX-License-Identifier: Apache-2.0
#include "json/fields.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

#include "base/load_error.h"
#include "base/unicode.h"

namespace wellspring::json {

using nlohmann::json;

static const json no_fields = json::object();

static std::string join(std::initializer_list<const char*> words) {
  return list_names(std::vector<std::string>(words.begin(), words.end()), words.size());
}

void Faults::add(const std::string& where, const std::string& what) {
  if (tell_) return tell_({where, what});
  if (file_.empty()) {
    if (!first) first = Fault{where, what};
    return;
  }
  if (text_.empty()) throw LoadError(file_, where, what);
  // A missing value has the line of the object that lacks it.
  int line = find_json_line(text_, where);
  if (line == 0) line = find_json_line(text_, where.substr(0, where.rfind('/')));
  throw LoadError(file_, "line " + std::to_string(line) + ", " + where, what);
}

void Faults::add_kind(const std::string& where, const std::string& kind) {
  add(where, (file_.empty() ? "must be " : "is not ") + kind);
}

void Faults::add_unknown(const std::string& where, const std::string& name,
                         const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  if (tell_) add_slight(where, "is not a field of this object and is ignored" + hint);
  else add(where, "is unknown" + hint + "; there are " + list_names(known, known.size()));
}

bool JsonValue::number(double low, double high, double& to) const {
  const double number = value_->is_number() ? value_->get<double>() : NAN;
  if (!(number >= low && number <= high))
    return fail_kind(fmt::format("a number from {:.10g} to {:.10g}", low, high)), false;
  return to = number, true;
}

bool JsonValue::number(double low, double high, float& to) const {
  double number = 0;
  return this->number(low, high, number) && (to = float(number), true);
}

bool JsonValue::whole(double low, double high, double& to) const {
  const double number = value_->is_number() ? value_->get<double>() : NAN;
  if (!(number >= low && number <= high) || number != std::floor(number))
    return fail_kind(fmt::format("a whole number from {:.10g} to {:.10g}", low, high)), false;
  return to = number, true;
}

bool JsonValue::boolean(bool& to) const {
  if (!value_->is_boolean()) return fail_kind("true or false"), false;
  return to = value_->get<bool>(), true;
}

bool JsonValue::text(std::string& to, size_t most_bytes, Need need) const {
  if (!value_->is_string()) return fail_kind("a text"), false;
  const auto& text = value_->get_ref<const std::string&>();
  if (text.size() > most_bytes)
    return fail_kind("a text of at most " + std::to_string(most_bytes) + " bytes"), false;
  if (std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
    return fail_kind("a text without control characters"), false;
  if (need == Need::required && text.empty()) return fail("is empty"), false;
  return to = text, true;
}

int JsonValue::word(std::initializer_list<const char*> words, Need need) const {
  std::string text;
  if (!this->text(text, max_text_bytes, need) || text.empty()) return -1;
  const auto found = std::ranges::find(words, text);
  if (found != words.end()) return int(found - words.begin());
  fail_kind("one of " + join(words) +
            did_you_mean(text, std::vector<std::string>(words.begin(), words.end())));
  return -1;
}

bool JsonValue::numbers(int count, double low, double high, double* to) const {
  if (!value_->is_array() || value_->size() != size_t(count)) {
    constexpr const char* counts[] = {"two", "three", "four"};
    const bool few = count >= 2 && count <= 4;
    fail_kind(fmt::format("a list of {} numbers", few ? counts[count - 2] : std::to_string(count)));
    return false;
  }
  for (int i = 0; i < count; i++) {
    const JsonValue one((*value_)[size_t(i)], *faults_, where_ + "/" + std::to_string(i));
    if (!one.number(low, high, to[i])) return false;
  }
  return true;
}

std::vector<JsonValue> JsonValue::list(size_t least, size_t most, const char* kind) const {
  std::vector<JsonValue> entries;
  if (!value_->is_array() || value_->size() < least)
    return fail_kind(std::string("a list of ") + kind), entries;
  const size_t count = std::min(value_->size(), most);
  entries.reserve(count);
  for (size_t i = 0; i < count; i++)
    entries.emplace_back((*value_)[i], *faults_, where_ + "/" + std::to_string(i));
  if (value_->size() > most) fail("must have at most " + std::to_string(most) + " entries");
  return entries;
}

bool JsonValue::object() const {
  if (!value_->is_object()) fail_kind("an object");
  return value_->is_object();
}

std::optional<JsonValue> JsonValue::find(const char* name) const {
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  return JsonValue(*found, *faults_, where_ + "/" + name);
}

FieldReader::FieldReader(const JsonValue& value) : JsonValue(value) {
  if (!object()) value_ = &no_fields;
}

FieldReader::FieldReader(nlohmann::ordered_json& schema) : JsonValue(no_fields), schema_(&schema) {
  schema["type"] = "object";
}

bool FieldReader::note(const char* name, nlohmann::ordered_json kind, const char* about,
                       Need need) {
  if (*about) kind["description"] = about;
  (*schema_)["properties"][name] = std::move(kind);
  if (need == Need::required) (*schema_)["required"].push_back(name);
  return false;
}

nlohmann::ordered_json FieldReader::list_schema(const nlohmann::ordered_json& entry, size_t least,
                                                size_t most) {
  nlohmann::ordered_json schema = {{"type", "array"}, {"items", entry}};
  if (least > 0) schema["minItems"] = least;
  if (most != SIZE_MAX) schema["maxItems"] = most;
  return schema;
}

nlohmann::ordered_json FieldReader::map_schema(const nlohmann::ordered_json& member) {
  return {{"type", "object"}, {"additionalProperties", member}};
}

std::optional<JsonValue> FieldReader::take(const char* name, Need need) {
  if (!faults_) return std::nullopt;
  if (faults_->strict) known_.emplace_back(name);
  auto field = find(name);
  if (!field && need == Need::required) fail(name, "is missing");
  return field;
}

std::optional<JsonValue> FieldReader::take(const char* name, const nlohmann::ordered_json& kind,
                                           const char* about, Need need) {
  if (schema_) note(name, kind, about, need);
  return take(name, need);
}

bool FieldReader::text(const char* name, std::string& to, const char* about, Need need,
                       size_t most_bytes) {
  if (schema_) return note(name, {{"type", "string"}}, about, need);
  const auto field = take(name, need);
  return field && field->text(to, most_bytes, need);
}

bool FieldReader::token(const char* name, std::string& to, const char* about) {
  return text(name, to, about, Need::optional, max_token_bytes);
}

bool FieldReader::name(const char* name, std::string& to, const char* about, Need need) {
  std::string text;
  if (!this->text(name, text, about, need)) return false;
  const bool fits = std::ranges::all_of(text, [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c)) || c == '_' || c == '-' || c == '.';
  });
  if (!fits || text.empty() || text.size() > 64)
    return faults_->add_kind(where_ + "/" + name,
                             "a name of 1 to 64 letters, digits, '_', '-', '.'"),
           false;
  return to = text, true;
}

bool FieldReader::word(const char* name, std::initializer_list<const char*> words, std::string& to,
                       const char* about, Need need) {
  if (schema_) return note(name, {{"enum", words}}, about, need);
  const auto field = take(name, need);
  if (!field) return false;
  if (need == Need::optional && field->value() == "") return to.clear(), true;
  const int index = field->word(words, need);
  return index >= 0 && (to = words.begin()[index], true);
}

void FieldReader::switch_or_number(const char* name, double low, double high,
                                   std::optional<std::variant<bool, float>>& to, const char* about,
                                   Need need) {
  if (schema_)
    note(name,
         {{"anyOf",
           {{{"type", "boolean"}}, {{"type", "number"}, {"minimum", low}, {"maximum", high}}}}},
         about, need);
  const auto field = take(name, need);
  float number = 0;
  if (!field) return;
  if (field->value().is_boolean()) to = field->value().get<bool>();
  else if (!field->value().is_number()) field->fail_kind("true, false or a number");
  else if (field->number(low, high, number)) to = number;
}

void FieldReader::place(const char* name, std::optional<vec2>& to, const char* about, Need need) {
  if (schema_) note(name, list_schema({{"type", "number"}}, 2, 2), about, need);
  const auto field = take(name, need);
  double numbers[2];
  if (field && field->numbers(2, 0, 1, numbers)) to = vec2(numbers[0], numbers[1]);
}

void FieldReader::spot(const char* name, double limit, std::optional<dvec3>& to, const char* about,
                       Need need) {
  dvec3 place{0};
  if (vector(name, limit, place, about, need)) to = place;
}

void FieldReader::speed(const char* name, double limit, vec3& to, const char* about, Need need) {
  dvec3 speed{0};
  if (!vector(name, limit, speed, about, need)) return;
  if (glm::length(speed) > limit) fail(name, fmt::format("must be at most {} m/s long", limit));
  to = vec3(speed);
}

bool FieldReader::degrees(const char* name, double low, double high, float& to, const char* about,
                          Need need) {
  double angle = 0;
  if (!number(name, low, high, angle, about, need)) return false;
  return to = float(angle * (3.14159265358979323846 / 180)), true;
}

std::vector<double> FieldReader::numbers(const char* name, size_t count, double low, double high) {
  std::vector<double> numbers(count);
  if (const auto field = take(name, Need::required))
    field->numbers(int(count), low, high, numbers.data());
  return numbers;
}

std::vector<JsonValue> FieldReader::list(const char* name, size_t least, size_t most,
                                         const char* kind, Need need) {
  const auto field = take(name, need);
  return field ? field->list(least, most, kind) : std::vector<JsonValue>{};
}

std::vector<std::pair<std::string, JsonValue>> FieldReader::members() {
  std::vector<std::pair<std::string, JsonValue>> all;
  for (const auto& [name, unused] : value_->items()) all.emplace_back(name, *take(name.c_str()));
  return all;
}

void FieldReader::describe_choice(
    std::initializer_list<std::initializer_list<const char*>> sets) const {
  if (!schema_) return;
  for (const auto& set : sets) (*schema_)["oneOf"].push_back({{"required", set}});
}

void FieldReader::finish() const {
  if (schema_) (*schema_)["additionalProperties"] = false;
  if (!faults_ || !faults_->strict) return;
  std::vector<std::string> known = known_;
  std::ranges::sort(known);
  for (const auto& [name, unused] : value_->items())
    if (std::ranges::find(known, name) == known.end())
      faults_->add_unknown(where_ + "/" + name, name, known);
}

}  // namespace wellspring::json
