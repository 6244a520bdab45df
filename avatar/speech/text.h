// SPDX-License-Identifier: Apache-2.0
// Divides texts into bytes, characters and words.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/speech.h"

namespace wellspring::avatar {

inline bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Returns the number of characters (code points) in the first `bytes` bytes of `text`.
size_t count_characters(std::string_view text, size_t bytes);
// Returns the byte of the first broken UTF-8 sequence or of a NUL, or npos. Overlong forms,
// surrogates and code points above U+10FFFF are broken.
size_t find_broken_utf8(std::string_view text);

// Returns the byte of each character's beginning, and the text's end.
std::vector<uint32_t> character_starts(std::string_view text);
// Returns the first byte from `at` on that is no space.
uint32_t skip_spaces(std::string_view text, uint32_t at);
// Returns the words of a text: what stands between spaces, without the marks around it. `is_said`
// says whether a word begins at a byte. It is asked with true after spaces: a piece without letter
// or digit is a word if it is said; and with false elsewhere: a word is cut there.
std::vector<SpeechWord> words_of(std::string_view text,
                                 const std::function<bool(uint32_t byte, bool begins)>& is_said);

// Says how parts of a text are spoken: slower, higher, stressed, after a silence, or by other words
// than are written. The voice program gets SSML 1.1 (W3C), which is made here.

struct SpeechStyle {
  uint32_t begin = 0, end = 0;            // bytes of the text; equal: only the pause
  float rate = 1, pitch = 1, volume = 1;  // factors of the speaker's own
  int emphasis = 0;                       // -1 reduced, 0 none, 1 moderate, 2 strong
  std::string alias{};                    // words said instead of the written ones
  float pause = 0;                        // seconds of silence before it
  bool operator==(const SpeechStyle&) const = default;
};

struct Ssml {
  std::string text;
  std::vector<uint32_t>
      source;  // for each character of `text`: the byte of the plain text it stands for
};

// Makes SSML. Styles may nest and overlap: factors multiply, the strongest emphasis holds, and
// among aliases the one that begins first. Styles outside the text or without sense (NaN, factors
// beyond 0.3 to 3, pauses beyond 0 to 10 s) are cut to what has sense.
Ssml make_ssml(std::string_view text, const std::vector<SpeechStyle>& styles);

// Returns a text that equal styles share and others do not: for keys of caches. Empty for no
// styles.
std::string describe_styles(const std::vector<SpeechStyle>& styles);

}  // namespace wellspring::avatar
