// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech.h"

#include <mutex>
#include <set>

#include "avatar/speech_shapes.h"
#include "base/log.h"

namespace wellspring {

namespace {

// Says the name of an unknown symbol once in the life of the program.
void say_unknown(const std::string& symbols, const SpeechPhoneme& phoneme) {
  static std::mutex mutex;
  static std::set<std::string> said;
  std::lock_guard lock(mutex);
  if (said.size() < 1000 && said.insert(symbols).second)
    log::warn("speech: no mouth shape is known for '{}' of phoneme [{}] ({}); the mouth holds",
              symbols, phoneme.ipa, phoneme.mnemonic);
}

}  // namespace

void fit_phonemes(Speech& speech) {
  std::vector<SpeechPhoneme> phonemes;
  double at = 0;
  auto add_pause = [&](double until) {
    if (until - at > 1e-3) phonemes.push_back({at, until, "_:", "", -1});
  };
  for (size_t i = 0; i < speech.phonemes.size();) {
    int index = speech.phonemes[i].word;
    size_t end = i;
    while (end < speech.phonemes.size() && speech.phonemes[end].word == index) end++;
    if (index >= 0) {
      const SpeechWord& word = speech.words[size_t(index)];
      double from = speech.phonemes[i].begin, length = speech.phonemes[end - 1].end - from;
      double scale = length > 0 ? (word.end - word.begin) / length : 0;
      add_pause(word.begin);
      for (size_t k = i; k < end; k++) {
        SpeechPhoneme phoneme = speech.phonemes[k];
        phoneme.begin = word.begin + (phoneme.begin - from) * scale;
        phoneme.end = k + 1 == end ? word.end : word.begin + (phoneme.end - from) * scale;
        phonemes.push_back(std::move(phoneme));
      }
      at = word.end;
    }
    i = end;
  }
  add_pause(speech.duration);
  speech.phonemes = std::move(phonemes);
}

void fill_visemes(Speech& speech) {
  std::vector<MouthSound> sounds;
  for (const SpeechPhoneme& phoneme : speech.phonemes) {
    MouthSound sound{phoneme.begin, phoneme.end, {}, is_pause(phoneme.mnemonic)};
    if (!sound.pause) {
      std::string unknown;
      sound.shapes = mouth_shapes(phoneme.ipa, &unknown);
      if (!unknown.empty()) say_unknown(unknown, phoneme);
    }
    sounds.push_back(std::move(sound));
  }
  speech.visemes = make_visemes(sounds);
}

}  // namespace wellspring
