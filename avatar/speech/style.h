// SPDX-License-Identifier: Apache-2.0
// How parts of a text are to be said: slower, higher, stressed, after a silence, or by other words
// than are written. The voice program is told by SSML 1.1 (W3C), which this makes.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace wellspring::avatar {

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
