// SPDX-License-Identifier: Apache-2.0
#include "avatar/face/library_json.h"

#include <algorithm>

namespace wellspring::avatar {
namespace {
constexpr int most_depth = 8;
}  // namespace

using nlohmann::json;

json LibraryReader::parse(std::string_view text, const char* format) const {
  if (text.size() > most_library_bytes) fail("", "is larger than 16 MiB");
  bool too_deep = false;
  auto guard = [&](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > most_depth;
    return !too_deep;
  };
  json root;
  try {
    root = json::parse(text, guard, true, true);  // comments are allowed
  } catch (const json::exception& error) {
    if (too_deep) fail("", "is nested too deep");
    fail("", error.what());
  }
  if (too_deep) fail("", "is nested too deep");
  object(root, "");
  const json* name = find(root, "format");
  if (!name || *name != format) fail("/format", "\"" + std::string(format) + "\" is expected");
  const json* version = find(root, "version");
  if (!version || *version != 1) fail("/version", "version 1 is expected");
  return root;
}

void LibraryReader::only(const json& object, const std::string& where,
                         std::initializer_list<std::string_view> known) const {
  for (const auto& [key, value] : object.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(where + "/" + key, "no such field is known");
}

const json& LibraryReader::list(const json& object, const std::string& where, const char* name,
                                size_t most) const {
  static const json none = json::array();
  const json* value = find(object, name);
  if (!value) return none;
  if (!value->is_array()) fail(where + "/" + name, "a list is expected");
  if (value->size() > most)
    fail(where + "/" + name, "more than " + std::to_string(most) + " entries");
  return *value;
}

float LibraryReader::number(const json& value, const std::string& where, double low,
                            double high) const {
  if (!value.is_number()) fail(where, "a number is expected");
  double number = value.get<double>();
  if (!(number >= low && number <= high)) {
    auto text = [](double v) { return json(v).dump(); };
    fail(where, "a number from " + text(low) + " to " + text(high) + " is expected");
  }
  return float(number);
}

float LibraryReader::number(const json& object, const std::string& where, const char* name,
                            double otherwise, double low, double high) const {
  const json* value = find(object, name);
  return value ? number(*value, where + "/" + name, low, high) : float(otherwise);
}

std::string LibraryReader::name(const json& object, const std::string& where,
                                const char* field) const {
  const json* value = find(object, field);
  if (!value) fail(where + "/" + field, "is missing");
  if (!value->is_string()) fail(where + "/" + field, "a name is expected");
  std::string text = value->get<std::string>();
  auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  if (text.empty() || text.size() > 64 || !std::all_of(text.begin(), text.end(), fits))
    fail(where + "/" + field, "a name of 1 to 64 letters, digits, '_', '-', '.' is expected");
  return text;
}

}  // namespace wellspring::avatar
