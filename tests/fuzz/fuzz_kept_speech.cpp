// SPDX-License-Identifier: Apache-2.0
// Speech that is kept on disk.
#include <cmath>

#include "avatar/speech/speech_json.h"
#include "fuzz/fuzz.h"
#include "fuzz/spoken.h"

namespace wellspring::fuzz {

void fuzz_kept_speech(Bytes bytes) {
  static const std::string path = folder().file("speech");
  static const std::string file = keep_speech(path);
  write_file("speech/" + file, bytes);
  const auto speech = SpeechFolder(path, 1 << 20).load(spoken_request());
  if (!speech) return;
  require(speech->rate > 0 && std::isfinite(speech->duration), "speech has a rate and a duration");
  for (const SpeechWord& word : speech->words)
    require(word.begin <= word.end && word.end <= speech->duration, "words lie in it");
}

}  // namespace wellspring::fuzz
