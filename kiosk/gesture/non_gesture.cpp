// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/non_gesture.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

using Row = std::array<double, orientation_codes>;

// A state, and how many it was merged from.
struct Member {
  Row output;
  double stay = 0, count = 1;
};

void merge_nearest(std::vector<Member>& members) {
  size_t a = 0, b = 1;
  double least = INFINITY;
  for (size_t i = 0; i < members.size(); i++)
    for (size_t j = i + 1; j < members.size(); j++)
      if (double d = divergence(members[i].output, members[j].output); d < least)
        least = d, a = i, b = j;
  const Member gone = members[b];
  Member& kept = members[a];
  const double all = kept.count + gone.count;
  for (size_t o = 0; o < orientation_codes; o++)
    kept.output[o] = (kept.count * kept.output[o] + gone.count * gone.output[o]) / all;
  kept.stay = (kept.count * kept.stay + gone.count * gone.stay) / all;
  kept.count = all;
  members.erase(members.begin() + ptrdiff_t(b));
}

}  // namespace

double divergence(const Row& a, const Row& b) {
  constexpr double least = 1e-9;  // instead of an impossible code's infinity
  double sum = 0;
  for (size_t o = 0; o < orientation_codes; o++)
    sum += (a[o] - b[o]) * std::log(std::max(a[o], least) / std::max(b[o], least));
  return sum;
}

void join_states(Hmm& model) {
  const int n = model.states;
  if (n == 1) model.at(0, 0) = 1;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (i != j) model.at(i, j) = (1 - model.at(i, i)) / (n - 1);
}

Hmm make_non_gesture(std::span<const Hmm> gestures, std::span<const double> last_stay,
                     const NonGestureSettings& settings) {
  std::vector<Member> members;
  for (size_t g = 0; g < gestures.size(); g++) {
    Hmm gesture = gestures[g];
    smooth_outputs(gesture, settings.smoothing);
    for (int i = 0; i < gesture.states; i++) {
      const bool last = i == gesture.states - 1;
      const double stay = last ? 1 - 1 / std::max(last_stay[g], 1.1) : gesture.at(i, i);
      members.push_back({gesture.output[size_t(i)], stay, 1});
    }
  }
  while (int(members.size()) > std::max(1, settings.states)) merge_nearest(members);
  Hmm model;
  model.states = int(members.size());
  const size_t n = members.size();
  model.initial.assign(n, 1 / double(n));
  model.transition.assign(n * n, 0);
  for (size_t i = 0; i < n; i++) {
    model.at(int(i), int(i)) = members[i].stay;
    model.output.push_back(members[i].output);
  }
  join_states(model);
  return model;
}

}  // namespace wellspring::kiosk
