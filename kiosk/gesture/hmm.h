// SPDX-License-Identifier: Apache-2.0
// Hidden Markov models over orientation codes (Rabiner 1989, sections III and V; Elmezain et al.
// 2009, section 3.1). All probabilities are computed in logarithms or scaled, so long sequences do
// not underflow.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace wellspring::kiosk {

inline constexpr int orientation_codes = 18;
using Code = uint8_t;  // 0..17

struct Hmm {
  int states = 0;
  std::vector<double> initial;     // Pi: states numbers, sum 1
  std::vector<double> transition;  // A: row i holds a_ij, each row's sum is 1
  std::vector<std::array<double, orientation_codes>> output;  // B: each row's sum is 1
  // Only sequences whose path ends in the last state count; else every state may be the last.
  bool ends_in_last = false;
  double at(int i, int j) const { return transition[size_t(i * states + j)]; }
  double& at(int i, int j) { return transition[size_t(i * states + j)]; }
};

// A left-right banded model: a state is kept or left for the next one, the last one is kept for
// ever. The stay in each state is `mean_codes` / `states` codes in the mean. Outputs are those of
// `sequences` cut into equal parts.
Hmm make_banded(int states, std::span<const std::vector<Code>> sequences);

// ln of the probability of the best path (equations 12 to 14), -infinity where there is none. Fills
// `path` with its states unless that is null. `codes` must not be empty.
double viterbi(const Hmm& model, std::span<const Code> codes, std::vector<int>* path = nullptr);

// One step of Baum-Welch: re-estimates the model in place and returns ln P of all sequences under
// the model as it was. Sequences that the model cannot produce are left out.
double improve(Hmm& model, std::span<const std::vector<Code>> sequences);

// Steps until ln P grows by less than `least` nats a sequence, at most `most` steps.
void train(Hmm& model, std::span<const std::vector<Code>> sequences, int most = 30,
           double least = 1e-3);

// Blurs outputs round the circle of codes by a Gaussian of this standard deviation, in codes.
void smooth_outputs(Hmm& model, double deviation);

// No output is less likely than `share` / 18: a stray code costs much, but not everything.
void raise_outputs(Hmm& model, double share);

}  // namespace wellspring::kiosk
