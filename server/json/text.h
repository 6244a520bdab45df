// SPDX-License-Identifier: Apache-2.0
// Turns JSON text into a tree of values within limits. The one bound of nesting and size for
// messages and files alike.
#pragma once
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "base/layers.h"
#include "base/read_file.h"

namespace wellspring::json {

// Bounds nesting (`[[1]]` has 2 levels), a file's bytes, and the bytes of a text and of a token
// that a server sealed; both are UTF-8 without control characters.
inline constexpr int max_json_depth = 32;
inline constexpr size_t max_json_bytes = size_t(32) << 20;
inline constexpr size_t max_text_bytes = 200, max_token_bytes = 4000;

// Says whether a field must be there.
enum class Need : uint8_t { optional, required };

// Says why a text was refused: `code` is a fixed word for programs, `message` a sentence.
struct JsonError {
  std::string code, message;
};

// Bounds how much of a text is made into values.
struct JsonLimits {
  int depth = max_json_depth;
  size_t values = SIZE_MAX;  // containers too
  bool comments = false;     // whether comments are allowed
};

// Parses within limits: nlohmann's own parser takes any depth, but copying or dumping its result of
// 100,000 brackets overflows the stack, and 20,000 empty arrays take milliseconds. Stops at the
// first value too many. Returns a JsonError (bad_json, too_deep, too_large; bad_field for a number
// no double can hold) naming the place. `values`: set to how many were read.
std::variant<nlohmann::json, JsonError> parse_json(std::string_view text,
                                                   const JsonLimits& limits = {},
                                                   size_t* values = nullptr);

// Reads a file's text, at most max_json_bytes; throws LoadError.
std::string read_json_text(const std::string& file, FileKind kind = FileKind::regular);
// Parses the text of a file; throws LoadError.
nlohmann::json parse_json_file(const std::string& file, std::string_view text,
                               bool comments = false);

// Returns the line, from 1, at which the name of the value at `place` stands ("/cameras/0/name",
// names as they are written), or the value itself in a list; of equal names the last. 0: there is
// none.
int find_json_line(std::string_view text, const std::string& place);

}  // namespace wellspring::json
