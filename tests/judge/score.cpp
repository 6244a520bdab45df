// SPDX-License-Identifier: Apache-2.0
#include "judge/score.h"

#include <algorithm>

namespace wellspring::test {

SpotCounts& SpotCounts::operator+=(const SpotCounts& other) {
  tests += other.tests;
  inserted += other.inserted;
  deleted += other.deleted;
  substituted += other.substituted;
  correct += other.correct;
  return *this;
}

double recognition_ratio(int correct, int tests) { return tests > 0 ? double(correct) / tests : 0; }

double reliability(const SpotCounts& counts) {
  return recognition_ratio(counts.correct, counts.tests + counts.inserted);
}

SpotCounts count_spotted(std::span<const TrueGesture> truth,
                         std::span<const SpottedGesture> spotted) {
  SpotCounts counts;
  counts.tests = int(truth.size());
  // If several meet the same true gesture, one of its own label is preferred.
  std::vector<int> state(truth.size());  // 0: missed, 1: another label, 2: correct
  for (const SpottedGesture& found : spotted) {
    double most = 0;
    size_t best = truth.size();
    for (size_t i = 0; i < truth.size(); i++) {
      const double shared =
          std::min(found.end, truth[i].end) - std::max(found.begin, truth[i].begin);
      const double shorter = std::min(found.end - found.begin, truth[i].end - truth[i].begin);
      if (shared > most && shared * 3 >= shorter) most = shared, best = i;
    }
    if (best == truth.size()) counts.inserted++;
    else {
      if (state[best] > 0) counts.inserted++;
      state[best] = std::max(state[best], truth[best].label == found.label ? 2 : 1);
    }
  }
  for (int s : state) {
    counts.deleted += s == 0;
    counts.substituted += s == 1;
    counts.correct += s == 2;
  }
  return counts;
}

}  // namespace wellspring::test
