// SPDX-License-Identifier: Apache-2.0
// What a voice is asked to say, and how.
#pragma once
#include <string>
#include <vector>

#include "avatar/speech/style.h"

namespace wellspring::avatar {

struct SpeechRequest {
  std::string text;            // UTF-8, at most 10,000 bytes
  std::string lang = "en";     // BCP 47
  int words_per_minute = 155;  // 80 to 450
  int pitch = 45;              // 0 to 100
  std::string variant{};       // of the voice: eSpeak NG's "f3", "m2", ...; empty: its own
  std::vector<SpeechStyle> styles{};
  bool operator==(const SpeechRequest&) const = default;
};

// What is wrong with a request, in words that name it; empty when nothing is.
std::string check_speech_request(const SpeechRequest& request);

}  // namespace wellspring::avatar
