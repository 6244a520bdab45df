// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/template.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "avatar/align/features.h"

namespace wellspring::avatar {

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

std::vector<WarpGap> gaps_before(const std::vector<SoundState>& states, bool blocks) {
  std::vector<WarpGap> gaps;
  for (size_t i = 0; i < states.size(); i++) {
    bool phoneme_begins = i == 0 || states[i].phoneme != states[i - 1].phoneme;
    gaps.push_back(states[i].word_begins      ? WarpGap::anything
                   : blocks && phoneme_begins ? WarpGap::silence
                                              : WarpGap::none);
  }
  gaps.push_back(WarpGap::anything);
  return gaps;
}

std::vector<std::vector<WarpReturn>> find_returns(const std::vector<SoundState>& states, float cost,
                                                  float cost_of_word) {
  std::vector<std::vector<WarpReturn>> returns(states.size());
  constexpr size_t none = size_t(-1);
  size_t word = none, before = none;  // where the word and the one before it begin
  for (size_t i = 0; i < states.size(); i++) {
    if (states[i].word_begins) before = word, word = i;
    bool phoneme_ends = i + 1 == states.size() || states[i + 1].phoneme != states[i].phoneme;
    if (!phoneme_ends) continue;
    if (word != none) returns[word].push_back({uint32_t(i), cost});
    if (before != none) returns[before].push_back({uint32_t(i), cost + cost_of_word});
  }
  return returns;
}

}  // namespace wellspring::avatar
