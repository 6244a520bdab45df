// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech/speech.h"

#include <algorithm>
#include <mutex>
#include <set>

#include "avatar/speech/visemes.h"
#include "base/log.h"

namespace wellspring::avatar {

namespace {

constexpr double shortest_other = 0.01;  // seconds of a sound between words

// Logs the name of an unknown symbol once in the life of the program.
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
  std::vector<SpeechPhoneme> said, others, phonemes;
  for (SpeechPhoneme& phoneme : speech.phonemes)
    if (phoneme.word >= 0) said.push_back(std::move(phoneme));
    else if (!is_pause(phoneme.mnemonic)) others.push_back(std::move(phoneme));
  std::stable_sort(
      others.begin(), others.end(),
      [](const SpeechPhoneme& a, const SpeechPhoneme& b) { return a.begin < b.begin; });
  double at = 0;
  size_t other = 0;
  auto add_pause = [&](double until) {
    if (until - at > 1e-3) phonemes.push_back({at, until, "_:", "", -1});
  };
  auto fill = [&](double until) {
    for (; other < others.size() && others[other].begin < until; other++) {
      SpeechPhoneme sound = others[other];
      sound.begin = std::max(sound.begin, at);
      sound.end = std::min(sound.end, until);
      if (sound.end - sound.begin < shortest_other) continue;
      add_pause(sound.begin);
      at = sound.end;
      phonemes.push_back(std::move(sound));
    }
    add_pause(until);
  };
  for (size_t i = 0; i < said.size();) {
    int index = said[i].word;
    size_t end = i;
    while (end < said.size() && said[end].word == index) end++;
    const SpeechWord& word = speech.words[size_t(index)];
    double from = said[i].begin, length = said[end - 1].end - from;
    double scale = length > 0 ? (word.end - word.begin) / length : 0;
    fill(word.begin);
    for (size_t k = i; k < end; k++) {
      SpeechPhoneme phoneme = said[k];
      phoneme.begin = word.begin + (phoneme.begin - from) * scale;
      phoneme.end = k + 1 == end ? word.end : word.begin + (phoneme.end - from) * scale;
      phonemes.push_back(std::move(phoneme));
    }
    at = word.end;
    i = end;
  }
  fill(speech.duration);
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

}  // namespace wellspring::avatar
