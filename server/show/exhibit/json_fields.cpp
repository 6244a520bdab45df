// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/json_fields.h"

#include <cmath>
#include <filesystem>
#include <fmt/core.h>
#include <sstream>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/unicode.h"
#include "wire/json.h"

namespace wellspring::show {
namespace {

std::string join(const std::vector<Problem>& problems) {
  std::string all;
  for (const Problem& problem : problems)
    if (problem.fatal) all += (all.empty() ? "" : "\n") + to_string(problem);
  return all;
}

}  // namespace

std::string to_string(const Problem& problem) {
  return problem.file + (problem.where.empty() ? "" : ": " + problem.where) + ": " + problem.what;
}

ExhibitError::ExhibitError(std::vector<Problem> problems_)
    : std::runtime_error(join(problems_)), problems(std::move(problems_)) {}

using nlohmann::json;

namespace {
const json empty_object = json::object();
constexpr size_t max_file_bytes = 8 << 20;

// Names are compared with those of scenes and of files (base/unicode.h).
void normalise(json& value) {
  if (value.is_string()) value = nfc(value.get_ref<const std::string&>());
  if (value.is_array())
    for (json& item : value) normalise(item);
  if (!value.is_object()) return;
  json made = json::object();
  for (auto& [name, item] : value.items()) {
    normalise(item);
    made[nfc(name)] = std::move(item);
  }
  value = std::move(made);
}
}  // namespace

std::optional<json> read_json_file(const std::string& file, std::vector<Problem>& problems) {
  auto refuse = [&](std::string what) {
    problems.push_back({file, "", std::move(what)});
    return std::nullopt;
  };
  std::string text;
  try {
    text = read_file(file, max_file_bytes);
  } catch (const LoadError& error) {
    return refuse(error.what_);
  }
  auto parsed = parse_json(text);
  if (const WireError* error = std::get_if<WireError>(&parsed)) return refuse(error->message);
  normalise(std::get<json>(parsed));
  return std::get<json>(std::move(parsed));
}

bool is_language_tag(const std::string& tag) {
  if (tag.size() < 2 || tag.size() > 35) return false;
  for (char c : tag)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') return false;
  return true;
}

Fields::Fields(const json& object, std::string file, std::string where,
               std::vector<Problem>& problems)
    : object_(object.is_object() ? object : empty_object),
      file_(std::move(file)),
      where_(std::move(where)),
      problems_(problems) {
  if (!object.is_object()) problems_.push_back({file_, where_, "must be an object"});
}

void Fields::problem(const std::string& name, const std::string& what, bool fatal) {
  problems_.push_back({file_, name.empty() ? where_ : where_ + "/" + name, what, fatal});
}

std::vector<std::string> Fields::names() const {
  std::vector<std::string> names;
  if (object_.is_object())
    for (const auto& [name, value] : object_.items()) names.push_back(name);
  return names;
}

bool Fields::has(const char* name) const { return object_.contains(name); }

const json* Fields::get(const char* name, bool required, json::value_t type,
                        const char* type_name) {
  read_.insert(name);
  auto found = object_.find(name);
  if (found == object_.end()) {
    if (required) problem(name, "is missing");
    return nullptr;
  }
  bool fits = type == json::value_t::number_float ? found->is_number() : found->type() == type;
  if (!fits) {
    problem(name, std::string("must be ") + type_name);
    return nullptr;
  }
  return &*found;
}

std::string Fields::text(const char* name, bool required, const std::string& otherwise) {
  const json* value = get(name, required, json::value_t::string, "a text");
  return value ? value->get<std::string>() : otherwise;
}

double Fields::number(const char* name, bool required, double otherwise, double low, double high) {
  const json* value = get(name, required, json::value_t::number_float, "a number");
  if (!value) return otherwise;
  double number = value->get<double>();
  if (!std::isfinite(number) || number < low || number > high) {
    problem(name, fmt::format("is {} but must be from {} to {}", number, low, high));
    return otherwise;
  }
  return number;
}

bool Fields::flag(const char* name, bool otherwise) {
  const json* value = get(name, false, json::value_t::boolean, "true or false");
  return value ? value->get<bool>() : otherwise;
}

dvec3 Fields::triple(const char* name, bool required, dvec3 otherwise) {
  const json* value = get(name, required, json::value_t::array, "three numbers");
  if (!value) return otherwise;
  dvec3 result(0);
  if (value->size() != 3) {
    problem(name, "must be three numbers");
    return otherwise;
  }
  for (int i = 0; i < 3; i++) {
    const json& part = (*value)[size_t(i)];
    if (!part.is_number() || !std::isfinite(part.get<double>()) ||
        std::abs(part.get<double>()) > 1e9) {
      problem(std::string(name) + "/" + std::to_string(i), "must be a number below 1e9");
      return otherwise;
    }
    result[i] = part.get<double>();
  }
  return result;
}

LocalText Fields::read_local_text(const json& value, const std::string& place) {
  LocalText result;
  if (value.is_string()) result["en"] = value.get<std::string>();
  else if (!value.is_object()) problem(place, "must be a text, or texts by language");
  else
    for (const auto& [tag, text] : value.items()) {
      if (!is_language_tag(tag)) problem(place + "/" + tag, "is no language tag such as en");
      else if (!text.is_string()) problem(place + "/" + tag, "must be a text");
      else result[tag] = text.get<std::string>();
    }
  return result;
}

LocalText Fields::local_text(const char* name, bool required) {
  const json* found = value(name);
  if (!found && required) problem(name, "is missing");
  return found ? read_local_text(*found, name) : LocalText{};
}

std::vector<LocalText> Fields::local_texts(const char* name, bool required) {
  std::vector<LocalText> result;
  if (const json* list = get(name, required, json::value_t::array, "a list of texts"))
    for (size_t i = 0; i < list->size(); i++)
      result.push_back(read_local_text((*list)[i], std::string(name) + "/" + std::to_string(i)));
  return result;
}

const json* Fields::value(const char* name) {
  read_.insert(name);
  auto found = object_.find(name);
  return found == object_.end() ? nullptr : &*found;
}

std::vector<std::string> Fields::texts(const char* name) {
  std::vector<std::string> result;
  if (const json* value = get(name, false, json::value_t::array, "a list of texts"))
    for (size_t i = 0; i < value->size(); i++) {
      if ((*value)[i].is_string()) result.push_back((*value)[i].get<std::string>());
      else problem(std::string(name) + "/" + std::to_string(i), "must be a text");
    }
  return result;
}

void Fields::finish() {
  const std::vector<std::string> known(read_.begin(), read_.end());
  for (const auto& [name, value] : object_.items())
    if (!read_.contains(name))
      problem(name, "is not a field of this object and is ignored" + did_you_mean(name, known),
              false);
}

}  // namespace wellspring::show
