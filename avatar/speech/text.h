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

}  // namespace wellspring::avatar
