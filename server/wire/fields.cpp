// SPDX-License-Identifier: Apache-2.0
#include "wire/fields.h"

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

}  // namespace wellspring::wire
