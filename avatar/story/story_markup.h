// SPDX-License-Identifier: Apache-2.0
// The markup of stories as a row of pieces: a small, forgiving subset of XML, so that SSML and
// plain text are both read. `<` that begins no tag and `&` that begins no entity stand for
// themselves; comments, declarations and processing instructions are passed over; prefixes of names
// ("ssml:break") are left away. Every piece knows its line and column.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wellspring::avatar {

struct MarkupPlace {
  int line = 1, column = 1;  // from 1; columns are characters
};
std::string to_string(const MarkupPlace& place);  // "line 3, column 14"

struct MarkupPiece {
  enum class Kind : uint8_t { text, open, close, lone } kind = Kind::text;
  std::string name;  // of a tag, in small letters
  std::string text;  // entities resolved
  std::vector<std::pair<std::string, std::string>> attributes;
  MarkupPlace place;
};

// Value of an attribute, or null.
const std::string* find_attribute(const MarkupPiece& piece, std::string_view name);

inline constexpr size_t most_markup_bytes = 1 << 20, most_markup_depth = 64;

// Tags are balanced in what is returned. Throws LoadError{file, place, what}: broken UTF-8, a tag
// that does not end, an attribute without a quoted value, tags that do not match, deeper nesting or
// more text than the limits.
std::vector<MarkupPiece> read_markup(std::string_view text, const std::string& file);
// One piece of text, in which nothing is a tag or an entity.
std::vector<MarkupPiece> read_plain_markup(std::string_view text, const std::string& file);

}  // namespace wellspring::avatar
