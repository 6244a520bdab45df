// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of expressions and gestures with checks: the first error is thrown as a LoadError
// with its JSON pointer. For the readers of this folder, in .cpp files only.
#pragma once
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/load_error.h"

namespace wellspring::avatar {

// Returns the data in avatar/library/ as compiled into the program, so that no installation lacks
// it.

std::string_view default_gestures_json();
std::string_view default_expressions_json();

inline constexpr size_t most_library_bytes = size_t(16) << 20;

struct LibraryReader {
  const std::string& file;

  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw LoadError(file, where, what);
  }

  // Parses the whole text: an object that calls itself `format`, version 1. Nesting, size and
  // syntax are checked.
  nlohmann::json parse(std::string_view text, const char* format) const;
  // Refuses fields that nobody reads: they are misspelt ones.
  void only(const nlohmann::json& object, const std::string& where,
            std::initializer_list<std::string_view> known) const;
  const nlohmann::json* find(const nlohmann::json& object, const char* name) const {
    auto found = object.find(name);
    return found == object.end() ? nullptr : &*found;
  }
  const nlohmann::json& object(const nlohmann::json& value, const std::string& where) const {
    if (!value.is_object()) fail(where, "an object is expected");
    return value;
  }
  // Returns a list of at most `most` entries; an absent one is empty.
  const nlohmann::json& list(const nlohmann::json& object, const std::string& where,
                             const char* name, size_t most) const;
  float number(const nlohmann::json& value, const std::string& where, double low,
               double high) const;
  float number(const nlohmann::json& object, const std::string& where, const char* name,
               double otherwise, double low, double high) const;
  // Returns a name: letters, digits, '_', '-' and '.'; 1 to 64 of them.
  std::string name(const nlohmann::json& object, const std::string& where,
                   const char* field = "name") const;
};

}  // namespace wellspring::avatar
