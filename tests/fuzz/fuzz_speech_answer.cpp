// SPDX-License-Identifier: Apache-2.0
// What the voice program answers: JSON, NUL, sound.
#include <cstring>

#include "avatar/speech/answer.h"
#include "fuzz/fuzz.h"

namespace wellspring::fuzz {

void fuzz_speech_answer(Bytes bytes) {
  const std::string json = text_of(take_until(bytes, 0));
  std::vector<int16_t> pcm(bytes.size() / 2);
  if (!pcm.empty()) std::memcpy(pcm.data(), bytes.data(), pcm.size() * 2);
  std::string error;
  const SpeechRequest request{.text = "The tower is old."};
  require(read_speech_answer(request, json, pcm, error) || !error.empty(), "a refusal says why");
}

}  // namespace wellspring::fuzz
