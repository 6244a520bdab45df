// SPDX-License-Identifier: Apache-2.0
// Texts as bytes, characters and words.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech/speech.h"

namespace wellspring::avatar {

inline bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

// Number of characters (code points) in the first `bytes` bytes of `text`.
size_t count_characters(std::string_view text, size_t bytes);
// Byte of the first broken UTF-8 sequence or of a NUL, or npos. Overlong forms, surrogates and what
// is above U+10FFFF are broken.
size_t find_broken_utf8(std::string_view text);

// Byte where each character begins, and the text's end.
std::vector<uint32_t> character_starts(std::string_view text);
// The first byte from `at` that is no space.
uint32_t skip_spaces(std::string_view text, uint32_t at);
// The words of a text: what stands between spaces, without the marks around it. `is_said` is asked
// whether a word is known to begin at a byte, with true where something follows a space: what has
// neither letter nor digit is a word if it is said; with false elsewhere: a word is cut there.
std::vector<SpeechWord> words_of(std::string_view text,
                                 const std::function<bool(uint32_t byte, bool begins)>& is_said);

// How parts of a text are to be said: slower, higher, stressed, after a silence, or by other words
// than are written. The voice program is told by SSML 1.1 (W3C), which this makes.

struct SpeechStyle {
  uint32_t begin = 0, end = 0;            // bytes of the text; equal: only the pause
  float rate = 1, pitch = 1, volume = 1;  // times the speaker's own
  int emphasis = 0;                       // -1 reduced, 0 none, 1 moderate, 2 strong
  std::string alias{};                    // said instead of what is written
  float pause = 0;                        // seconds of silence before it
  bool operator==(const SpeechStyle&) const = default;
};

struct Ssml {
  std::string text;
  std::vector<uint32_t>
      source;  // per character of `text`: the byte of the plain text it stands for
};

// Styles may nest and overlap: factors multiply, the strongest emphasis holds, of aliases the one
// that begins first. What lies outside the text or makes no sense (NaN, factors beyond 0.3 to 3,
// pauses beyond 0 to 10 s) is cut to what does.
Ssml make_ssml(std::string_view text, const std::vector<SpeechStyle>& styles);

// A text that equal styles share and others do not: for keys of caches. Empty for no styles.
std::string describe_styles(const std::vector<SpeechStyle>& styles);

}  // namespace wellspring::avatar
