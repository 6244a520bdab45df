// SPDX-License-Identifier: Apache-2.0
// Reads checked fields out of one JSON object; for the readers of this folder. The first fault is
// kept in `error` with the field's full name and turns every later call into nothing, so a reader
// asks for its fields one after the other and looks at the error once.
#pragma once
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>

#include "base/vec.h"
#include "wire/json.h"
#include "wire/limits.h"

namespace wellspring::wire {

class Fields {
 public:
  // `prefix` names the object in messages ("people[2]."). `object` and `error` are borrowed and
  // must live longer.
  Fields(const nlohmann::json& object, std::string prefix, std::optional<WireError>& error);

  // These return true if the field is there and good; the value is written only then.
  bool number(const char* name, double low, double high, double& value, Need need = Need::optional);
  bool number(const char* name, double low, double high, float& value, Need need = Need::optional);
  bool whole(const char* name, double low, double high, double& value, Need need = Need::optional);
  bool u32(const char* name, uint32_t& value, Need need = Need::optional);
  bool integer(const char* name, int low, int high, int& value, Need need = Need::optional);
  bool boolean(const char* name, bool& value, Need need = Need::optional);
  bool switch_or_number(const char* name, double low, double high,
                        std::optional<std::variant<bool, float>>& value,
                        Need need = Need::optional);
  // Reads a text of at most `most_bytes`, without control characters; a required one must not be
  // empty.
  bool text(const char* name, std::string& value, Need need = Need::optional,
            size_t most_bytes = max_name_bytes);
  // Reads one of `words`; with Need::optional also the empty string.
  bool word(const char* name, std::initializer_list<const char*> words, std::string& value,
            Need need = Need::optional);
  // Reads an array of exactly `count` numbers, each within +-limit.
  bool numbers(const char* name, int count, double limit, double* values,
               Need need = Need::optional);
  bool vector(const char* name, double limit, vec2& value, Need need = Need::optional);
  bool vector(const char* name, double limit, vec3& value, Need need = Need::optional);
  bool vector(const char* name, double limit, dvec3& value, Need need = Need::optional);
  // These return the member itself if it is there and of that type.
  const nlohmann::json* object(const char* name);
  const nlohmann::json* array(const char* name, size_t max_size);

  bool is_null(const char* name) const;  // the field is there and null
  void fail(const std::string& name, const std::string& what);
  bool good() const { return !error_; }

 private:
  const nlohmann::json* find(const char* name, Need need);
  bool check_number(const std::string& name, const nlohmann::json& value, double low, double high,
                    double& out);

  const nlohmann::json& object_;
  std::string prefix_;
  std::optional<WireError>& error_;
};

// Holds the object of a message whose size, syntax, depth and count of values are good and which
// has a "type" of type string.
struct Envelope {
  nlohmann::json object;
  std::string type;
};
struct EnvelopeLimits {
  size_t bytes = max_message_bytes, values = max_observation_values;
};
std::variant<Envelope, WireError> open_envelope(std::string_view text,
                                                const EnvelopeLimits& limits = {},
                                                size_t* values = nullptr);
WireError too_large(size_t most_bytes);

// Quotes a piece of a stranger's text for a message of ours: short, no control characters.
std::string short_quote(std::string_view text);

}  // namespace wellspring::wire
