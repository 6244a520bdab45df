// SPDX-License-Identifier: Apache-2.0
#include "avatar/story/story_sentence.h"

#include <array>

#include "avatar/speech/text.h"

namespace wellspring::avatar {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c & 0x80) || ((c | 32) >= 'a' && (c | 32) <= 'z'); }

// Bytes of one of `marks` at the beginning of `text`; 0: none.
template <size_t N>
size_t mark_of(std::string_view text, const std::array<std::string_view, N>& marks) {
  for (std::string_view mark : marks)
    if (text.substr(0, mark.size()) == mark) return mark.size();
  return 0;
}

constexpr std::array<std::string_view, 9> ends = {".", "!", "?", "…", "。", "！", "？", "؟", "।"};
constexpr std::array<std::string_view, 9> closings = {"\"", "'", ")", "]", "”", "’", "“", "»", "«"};

// Whether `text` begins with a small letter of the Latin, Greek or Cyrillic script, as far as case
// can be told from the bytes: ASCII, Latin-1, and Latin Extended-A by its pairs.
bool begins_small(std::string_view text) {
  if (text.empty()) return false;
  unsigned char a = static_cast<unsigned char>(text[0]);
  if (a < 0x80) return a >= 'a' && a <= 'z';
  if (text.size() < 2 || (a & 0xe0) != 0xc0) return false;
  unsigned code = (a & 0x1fu) << 6 | (static_cast<unsigned char>(text[1]) & 0x3fu);
  if (code >= 0xdf && code <= 0xff) return code != 0xf7;
  if (code >= 0x100 && code <= 0x17f) {
    bool odd_is_small = code < 0x139 || (code > 0x148 && code < 0x179);
    return (code % 2 == 1) == odd_is_small;
  }
  return (code >= 0x3ac && code <= 0x3ce) || (code >= 0x430 && code <= 0x45f);
}

// Whether the full stop at `at` belongs to what stands before it.
bool abbreviates(std::string_view text, size_t at, size_t begin) {
  if (at == begin) return true;
  if (is_digit(text[at - 1]))
    return at < begin + 3 || !is_digit(text[at - 3]);  // 13. but not 1786.
  size_t word = at;
  while (word > begin && is_letter(text[word - 1])) word--;
  size_t characters = 0;
  for (size_t i = word; i < at; i++) characters += (text[i] & 0xc0) != 0x80;
  return characters == 1;
}

}  // namespace

std::vector<TextSpan> find_sentences(std::string_view text) {
  std::vector<TextSpan> spans;
  size_t begin = 0, at = 0;
  auto close = [&](size_t end) {
    size_t from = begin, to = end;
    while (from < to && is_space(text[from])) from++;
    while (to > from && is_space(text[to - 1])) to--;
    if (to > from) spans.push_back({uint32_t(from), uint32_t(to)});
    begin = end;
  };
  while (at < text.size()) {
    size_t mark = mark_of(text.substr(at), ends);
    if (mark == 0) {
      at++;
      continue;
    }
    bool lone_stop = text[at] == '.' && abbreviates(text, at, begin);
    size_t end = at;
    while (size_t more = mark_of(text.substr(end), ends)) end += more;
    lone_stop = lone_stop && end == at + 1;
    while (size_t more = mark_of(text.substr(end), closings)) end += more;
    bool wide = mark == 3 && text.substr(at, 3) != "…";  // no space follows 。
    size_t next = end;
    while (next < text.size() && is_space(text[next])) next++;
    bool ends_here =
        next == text.size() || wide || (next > end && !begins_small(text.substr(next)));
    if (ends_here && (!lone_stop || next == text.size())) close(end);
    at = end;
  }
  close(text.size());
  return spans;
}

}  // namespace wellspring::avatar
