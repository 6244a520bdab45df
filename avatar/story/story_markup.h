// SPDX-License-Identifier: Apache-2.0
// Reads the markup of stories as a row of pieces: a small, forgiving subset of XML, so that SSML
// and plain text are both read. `<` that begins no tag and `&` that begins no entity stand for
// themselves; comments, declarations and processing instructions are passed over; prefixes of names
// ("ssml:break") are left away. Every piece knows its line and column.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wellspring::avatar {

// Reads character references of HTML, as stories and subtitles may have them: &amp;, &eacute; and
// all other names of HTML 4, &apos;, and numbers (&#8211;, &#x2013;).

// Appends the character that the reference at the beginning of `text` stands for. Returns the
// reference's bytes; 0 when none begins there.
size_t read_character_reference(std::string_view text, std::string& to);

struct MarkupPlace {
  int line = 1, column = 1;  // from 1; columns are characters
};
std::string to_string(const MarkupPlace& place);  // "line 3, column 14"

struct MarkupPiece {
  enum class Kind : uint8_t { text, open, close, lone } kind = Kind::text;
  std::string name;  // name of a tag, in small letters
  std::string text;  // entities resolved
  std::vector<std::pair<std::string, std::string>> attributes;
  MarkupPlace place;
};

// Returns the value of an attribute, or null.
const std::string* find_attribute(const MarkupPiece& piece, std::string_view name);

inline constexpr size_t most_markup_bytes = 1 << 20, most_markup_depth = 64;

// Returns pieces with balanced tags. Throws LoadError{file, place, what}: broken UTF-8, a tag that
// does not end, an attribute without a quoted value, tags that do not match, deeper nesting or more
// text than the limits.
std::vector<MarkupPiece> read_markup(std::string_view text, const std::string& file);
// Returns one piece of text, in which nothing is a tag or an entity.
std::vector<MarkupPiece> read_plain_markup(std::string_view text, const std::string& file);

// Reads values of attributes of a story's markup, as SSML 1.1 writes them; empty if there is none.

std::optional<float> read_seconds(const std::string& text);         // "500ms", "1.5s"; at most 10 s
std::optional<float> read_break_strength(const std::string& text);  // seconds; none .. x-strong
// These are factors of the speaker's own: "80%", "+10%", "-2st", "slow", "1.2"; cut to 0.3 .. 3.
std::optional<float> read_rate(const std::string& text);
std::optional<float> read_pitch(const std::string& text);
std::optional<float> read_volume(const std::string& text);  // "+6dB", "loud", "80%"
std::optional<float> read_weight(const std::string& text);  // 0 .. 1, or "60%"
std::optional<float> read_turn(const std::string& text);    // degrees, -720 .. 720: "90", "-45deg"
std::optional<int> read_emphasis(const std::string& text);  // -1 .. 2

}  // namespace wellspring::avatar
