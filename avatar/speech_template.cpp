// SPDX-License-Identifier: Apache-2.0
#include "avatar/speech_template.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "avatar/speech_features.h"

namespace wellspring {

namespace {

std::string kind_name(const SpeechPhoneme& phoneme) {
  std::string name = phoneme.ipa;
  for (const std::string mark : {"ː", "ˑ", "ˈ", "ˌ"})
    for (size_t at; (at = name.find(mark)) != std::string::npos;) name.erase(at, mark.size());
  return name;
}

}  // namespace

std::vector<SoundState> make_states(const Speech& spoken, size_t frame_count, size_t pieces) {
  std::vector<SoundState> states;
  int word = -1;
  for (size_t p = 0; p < spoken.phonemes.size(); p++) {
    const SpeechPhoneme& phoneme = spoken.phonemes[p];
    if (phoneme.word < 0) continue;
    size_t first = std::min(size_t(std::lround(phoneme.begin / feature_hop)), frame_count - 1);
    size_t end = size_t(std::lround(phoneme.end / feature_hop));
    size_t frames = std::clamp(end, first + 1, frame_count) - first;
    size_t count = pieces == 0 ? frames : std::clamp<size_t>(frames / 2, 1, pieces);
    for (size_t k = 0; k < count; k++) {
      SoundState state;
      state.phoneme = uint32_t(p);
      state.frame = first + frames * k / count;
      state.frames = first + frames * (k + 1) / count - state.frame;
      state.word_begins = k == 0 && phoneme.word != word;
      states.push_back(state);
    }
    word = phoneme.word;
  }
  return states;
}

uint32_t number_kinds(const Speech& spoken, std::vector<SoundState>& states) {
  std::map<std::pair<std::string, size_t>, uint32_t> numbers;
  for (size_t i = 0; i < states.size();) {
    size_t end = i;
    while (end < states.size() && states[end].phoneme == states[i].phoneme) end++;
    std::string name = kind_name(spoken.phonemes[states[i].phoneme]);
    for (size_t k = i; k < end; k++) {
      size_t place = k == i ? 0 : k + 1 == end ? 2 : 1;
      states[k].kind = numbers.try_emplace({name, place}, uint32_t(numbers.size())).first->second;
    }
    i = end;
  }
  return uint32_t(numbers.size());
}

std::vector<bool> gaps_before(const std::vector<SoundState>& states) {
  std::vector<bool> gaps;
  for (const SoundState& state : states) gaps.push_back(state.word_begins);
  gaps.push_back(true);
  return gaps;
}

}  // namespace wellspring
