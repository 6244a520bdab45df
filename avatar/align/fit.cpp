// SPDX-License-Identifier: Apache-2.0
#include "avatar/align/fit.h"

#include <cmath>
#include <limits>
#include <utility>

#include "avatar/align/coarse.h"
#include "base/rng.h"

namespace wellspring::avatar {

namespace {

// The states with their words in another order.
std::vector<SoundState> reorder(const std::vector<SoundState>& states, Rng& rng) {
  std::vector<std::pair<size_t, size_t>> words;  // first state, past the last
  for (size_t i = 0; i < states.size(); i++) {
    if (states[i].word_begins || words.empty()) words.push_back({i, i});
    words.back().second = i + 1;
  }
  for (size_t i = words.size(); i-- > 1;)
    std::swap(words[i], words[std::min(size_t(rng.uniform() * float(i + 1)), i)]);
  std::vector<SoundState> mixed;
  for (auto [first, last] : words)
    mixed.insert(mixed.end(), states.begin() + ptrdiff_t(first), states.begin() + ptrdiff_t(last));
  return mixed;
}

}  // namespace

double eval_fit(const Speech& spoken, const Sound& recording) {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  if (spoken.words.size() < size_t(fit_words)) return unknown;
  SoundPair pair = make_sound_pair(spoken, recording);
  auto states = make_states(spoken, pair.spoken.size(), 0);
  if (states.empty()) return unknown;
  CoarseWay own = warp_coarsely(pair, states);
  if (own.way.empty()) return 0;  // far too short for it
  Rng rng{1};
  double sum = 0, squares = 0, count = 0;
  for (int i = 0; i < fit_orders; i++) {
    CoarseWay other = warp_coarsely(pair, reorder(states, rng));
    if (other.way.empty()) continue;
    sum += other.cost, squares += other.cost * other.cost, count++;
  }
  if (count < 2) return unknown;
  double mean = sum / count, variance = (squares - count * mean * mean) / (count - 1);
  return (mean - own.cost) / std::sqrt(std::max(variance, 1e-12));
}

}  // namespace wellspring::avatar
