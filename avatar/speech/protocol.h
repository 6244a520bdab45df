// SPDX-License-Identifier: Apache-2.0
// Defines the messages between the voice program (voice/main.cpp) and its client, over the
// program's standard input and output. Both directions use the same frame, little-endian:
//
//   u32 length of the JSON, u32 length of the sound, JSON (UTF-8), sound (16-bit mono PCM)
//
// On starting the program says {"engine":"...","languages":["en-gb",...]}; then, for every request,
// in order, exactly one answer:
//   request  {"id":n, "text":"...", "lang":"de", "words_per_minute":165, "pitch":50}, and perhaps
//            "variant":"f3" of the voice and "ssml":true, when the text is SSML 1.1
//   answer   {"id":n, "rate":22050, "voice":"German",
//             "words":[[sample, character, characters], ...],
//             "phonemes":[[sample, word, "mnemonic", "ipa"], ...]} and the sound; `word` counts the
//             entries of "words", -1 before the first; a phoneme lasts until the next begins.
//   or       {"id":n, "error":"one sentence"}
// The program ends when its input ends.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "avatar/speech/text.h"

namespace wellspring::avatar::speech_protocol {

inline constexpr size_t header_bytes = 8;
inline constexpr size_t max_text_bytes = 10000;           // length of one request, some ten minutes
inline constexpr uint32_t max_request_json = 128 * 1024;  // escapes make a text longer
inline constexpr uint32_t max_answer_json = 32 * 1024 * 1024;
inline constexpr uint32_t max_sound_bytes = 128 * 1024 * 1024;
inline constexpr int min_words_per_minute = 80, max_words_per_minute = 450;

struct Header {
  uint32_t json = 0, sound = 0;
};

inline Header read_header(const unsigned char bytes[header_bytes]) {
  auto u32 = [&](size_t at) {
    return uint32_t(bytes[at]) | uint32_t(bytes[at + 1]) << 8 | uint32_t(bytes[at + 2]) << 16 |
           uint32_t(bytes[at + 3]) << 24;
  };
  return {u32(0), u32(4)};
}

inline std::string write_header(uint32_t json, uint32_t sound) {
  std::string bytes;
  for (uint32_t value : {json, sound})
    for (int shift = 0; shift < 32; shift += 8) bytes += char(value >> shift & 255);
  return bytes;
}

}  // namespace wellspring::avatar::speech_protocol

namespace wellspring::avatar {

// Holds the text that a voice is asked to say, and how.

struct SpeechRequest {
  std::string text;            // UTF-8, at most 10,000 bytes
  std::string lang = "en";     // BCP 47
  int words_per_minute = 155;  // 80 to 450
  int pitch = 45;              // 0 to 100
  std::string variant{};       // variant of the voice: eSpeak NG's "f3", "m2", ...; empty: its own
  std::vector<SpeechStyle> styles{};
  bool operator==(const SpeechRequest&) const = default;
};

// Returns the fault of a request, in words that name it; empty when there is none.
std::string check_speech_request(const SpeechRequest& request);

}  // namespace wellspring::avatar
