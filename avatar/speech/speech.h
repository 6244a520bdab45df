// SPDX-License-Identifier: Apache-2.0
// Holds a spoken sentence as one value: the sound, and when each word, phoneme and mouth shape of
// it comes. It is the same whether a synthesiser made the sound or a narrator was recorded. It is
// immutable once made, and shared between threads as shared_ptr<const Speech>. Times are seconds
// from the first sample of `pcm`, never decreasing; begin <= end <= duration.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "avatar/speech/visemes.h"

namespace wellspring::avatar {

struct SpeechWord {
  double begin = 0, end = 0;
  uint32_t text_begin = 0, text_end = 0;  // bytes of Speech::text
};

struct SpeechPhoneme {
  double begin = 0, end = 0;
  std::string mnemonic;  // eSpeak NG's name; "_:" and the like are pauses
  std::string ipa;       // International Phonetic Alphabet; empty for a pause
  int word = -1;  // index into Speech::words; -1 for a pause, and for vain beginnings of a word
};

struct Speech {
  std::string text, lang;    // UTF-8; BCP 47 as requested
  int rate = 22050;          // samples a second
  std::vector<int16_t> pcm;  // mono
  std::vector<SpeechWord> words;
  std::vector<SpeechPhoneme> phonemes;  // pauses included
  VisemeTrack visemes;
  double duration = 0;    // seconds of pcm
  bool recorded = false;  // by a narrator, with silence around it
};

// Stretches the phonemes of every word into its begin and end, keeping their proportions, and puts
// pauses between words that do not meet. Earlier pauses are dropped first; sounds of no word (of a
// speaker who stutters) keep their times as far as words leave them room.
void fit_phonemes(Speech& speech);

// Makes mouth shapes from phonemes and their times: fills `speech.visemes`.
void fill_visemes(Speech& speech);

}  // namespace wellspring::avatar
