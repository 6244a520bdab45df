// SPDX-License-Identifier: Apache-2.0
// Texts as bytes, characters and words.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "avatar/speech.h"

namespace wellspring {

// Number of characters (code points) in the first `bytes` bytes of `text`.
size_t count_characters(std::string_view text, size_t bytes);
// Byte of the first broken UTF-8 sequence or of a NUL, or npos. Overlong forms, surrogates and what
// is above U+10FFFF are broken.
size_t find_broken_utf8(std::string_view text);

// Byte where each character begins, and the text's end.
std::vector<uint32_t> character_starts(std::string_view text);
// The first byte from `at` that is no space.
uint32_t skip_spaces(std::string_view text, uint32_t at);
// The words between two bytes: what stands between spaces, without the marks around it. What
// has neither letter nor digit is no word, but for the first, which somebody said.
std::vector<SpeechWord> words_between(std::string_view text, uint32_t begin, uint32_t end);

}  // namespace wellspring
