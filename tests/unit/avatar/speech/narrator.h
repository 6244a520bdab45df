// SPDX-License-Identifier: Apache-2.0
// Narrators whose times are known: a synthesiser's voice that pauses, stutters, drags sounds out,
// and is heard through a room, a hissing microphone or a telephone.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "avatar/speech/speech.h"
#include "avatar/speech/process.h"
#include "avatar/speech/sound_file.h"
#include "base/layers.h"

namespace wellspring::test {

// Chances are for each word, one of them at most befalls a word.
struct Manner {
  float pause = 0;    // 0.15 to 0.8 s of silence before it
  float repeat = 0;   // its first sounds are said once to three times before it, some dragged out
  float again = 0;    // the word before it is said once more
  float prolong = 0;  // one of its sounds that can last, lasts 0.2 to 0.7 s longer
  float block = 0;    // 0.1 to 0.4 s of silence after its first sound
  float filler = 0;   // a sound that is not in the text before it
  float breath = 0;   // for each 0.2 s of silence: is one of breathing
  float clicks = 0;   // a second, as of an old tape
  float hiss = 0;     // standard deviation of the noise; 1 is full scale
  float hum = 0;      // amplitude of 50 Hz and its third harmonic
  double room = 0;    // seconds until the room's echo is 60 dB down
  int rate = 22050;   // samples a second: 8000 is a telephone
  uint64_t seed = 1;
};

struct Narrated {
  Sound recording;
  std::vector<SpeechWord> words;  // when each comes; of a repeated one, the last time
};

// The speech of `request` in this manner.
Narrated narrate(SpeechProcess& process, const SpeechRequest& request, const Manner& manner);

}  // namespace wellspring::test
