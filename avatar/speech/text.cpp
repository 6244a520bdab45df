// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/text.h"

#include <algorithm>

namespace wellspring::avatar {

namespace {

bool is_ascii_mark(char c) {
  return (c >= '!' && c <= '/' && c != '%' && c != '$' && c != '&') || (c >= ':' && c <= '@') ||
         (c >= '[' && c <= '`') || (c >= '{' && c <= '~');
}

// Bytes of the mark that `text` begins or ends with: ASCII punctuation, U+2010 to U+206F,
// guillemets and the opening marks of Spanish. 0: none.
size_t mark_at(std::string_view text, bool front) {
  if (text.empty()) return 0;
  if (is_ascii_mark(front ? text.front() : text.back())) return 1;
  auto is = [&](size_t size, auto test) {
    size_t at = front ? 0 : text.size() - size;
    return text.size() >= size && test(text.substr(at, size));
  };
  auto is_two = [](std::string_view s) { return s == "«" || s == "»" || s == "¿" || s == "¡"; };
  auto is_three = [](std::string_view s) {
    return s[0] == '\xe2' && (s[1] == '\x80' || s[1] == '\x81');
  };
  return is(2, is_two) ? 2 : is(3, is_three) ? 3 : 0;
}

bool is_letter_or_digit(char c) {
  return (c & 0x80) || (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z');
}

}  // namespace

size_t count_characters(std::string_view text, size_t bytes) {
  text = text.substr(0, std::min(bytes, text.size()));
  return size_t(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

size_t find_broken_utf8(std::string_view text) {
  for (size_t i = 0; i < text.size();) {
    auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
    unsigned char first = byte(i);
    size_t more = first < 0x80   ? 0
                  : first < 0xc2 ? 4
                  : first < 0xe0 ? 1
                  : first < 0xf0 ? 2
                  : first < 0xf5 ? 3
                                 : 4;
    if (more == 4 || first == 0 || i + more >= text.size()) return i;
    for (size_t k = 1; k <= more; k++)
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    if (more >= 2) {
      unsigned char second = byte(i + 1);
      bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
      bool surrogate = first == 0xed && second >= 0xa0;
      bool too_high = first == 0xf4 && second >= 0x90;
      if (overlong || surrogate || too_high) return i;
    }
    i += more + 1;
  }
  return std::string_view::npos;
}

std::vector<uint32_t> character_starts(std::string_view text) {
  std::vector<uint32_t> starts;
  for (uint32_t i = 0; i < text.size(); i++)
    if ((text[i] & 0xc0) != 0x80) starts.push_back(i);
  starts.push_back(uint32_t(text.size()));
  return starts;
}

uint32_t skip_spaces(std::string_view text, uint32_t at) {
  while (at < text.size() && is_space(text[at])) at++;
  return at;
}

std::vector<SpeechWord> words_of(std::string_view text,
                                 const std::function<bool(uint32_t byte, bool begins)>& is_said) {
  std::vector<SpeechWord> words;
  for (uint32_t at = skip_spaces(text, 0); at < text.size(); at = skip_spaces(text, at)) {
    uint32_t from = at;
    bool begins = from == 0 || is_space(text[from - 1]);
    do at++;
    while (at < text.size() && !is_space(text[at]) &&
           ((text[at] & 0xc0) == 0x80 || !is_said(at, false)));
    std::string_view whole = text.substr(from, at - from), inner = whole;
    while (size_t size = mark_at(inner, true)) inner.remove_prefix(size);
    while (size_t size = mark_at(inner, false)) inner.remove_suffix(size);
    if (std::none_of(inner.begin(), inner.end(), is_letter_or_digit)) {
      if (!is_said(from, begins)) continue;
      inner = whole;
    }
    uint32_t first = uint32_t(inner.data() - text.data());
    words.push_back({0, 0, first, first + uint32_t(inner.size())});
  }
  return words;
}

}  // namespace wellspring::avatar
