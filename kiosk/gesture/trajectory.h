// SPDX-License-Identifier: Apache-2.0
// Turns a hand's way into orientation codes (Elmezain et al. 2009, section 3.1). Places are in
// shoulder widths from the middle of the face: x to the right as the visitor sees the screen, y
// down. Times are seconds and grow.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::kiosk {

// Trains and evaluates hidden Markov models over orientation codes (Rabiner 1989, sections III and
// V; Elmezain et al. 2009, section 3.1). All probabilities are computed in logarithms or scaled, so
// long sequences do not underflow.

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

// Makes a left-right banded model: a state is kept or left for the next one, the last one is kept
// for ever. The stay in each state is `mean_codes` / `states` codes in the mean. Outputs are those
// of `sequences` cut into equal parts.
Hmm make_banded(int states, std::span<const std::vector<Code>> sequences);

// Returns ln of the probability of the best path (equations 12 to 14), -infinity if there is none.
// Fills `path` with its states unless that is null. `codes` must not be empty.
double viterbi(const Hmm& model, std::span<const Code> codes, std::vector<int>* path = nullptr);

// Does one step of Baum-Welch: re-estimates the model in place and returns ln P of all sequences
// under the model as it was. Sequences that the model cannot produce are left out.
double improve(Hmm& model, std::span<const std::vector<Code>> sequences);

// Repeats steps until ln P grows by less than `least` nats a sequence, at most `most` steps.
void train(Hmm& model, std::span<const std::vector<Code>> sequences, int most = 30,
           double least = 1e-3);

// Blurs outputs round the circle of codes by a Gaussian of this standard deviation, in codes.
void smooth_outputs(Hmm& model, double deviation);

// Raises outputs to `share` / 18 at least: a stray code costs much, but not everything.
void raise_outputs(Hmm& model, double share);

struct HandPlace {
  double time = 0;
  vec2 place{0};
};

// This is one movement, with its meaning.
struct HandPath {
  std::string label;    // "3", "wave"; empty: no gesture
  std::string variant;  // one of several orders of strokes; each has a model of its own
  std::vector<HandPlace> places;
};

// Returns the angle of a step as one of 18 sectors of 20 degrees: 0 is to the right, 4 or 5 down (y
// grows downwards), 9 to the left. `step` must not be 0.
Code orientation_code(vec2 step);

// This is a straight step of the hand from one place to another, always `code_step` long: so a code
// means a piece of the way, however quick it was, and places trembling by less are no motion.
inline constexpr float code_step = 0.06f;  // shoulder widths: 2.5 cm
struct CodedStep {
  Code code = 0;
  double begin = 0, end = 0;
  vec2 from{0}, to{0};
};

class OrientationCoder {
 public:
  // Adds the steps that the hand made up to here to `out`. Returns whether motion begins anew: at
  // the first place, or if the hand rested for `rest` seconds, was away for `away`, or is too far
  // from its last place to have moved there. A place that is not finite or beyond `reach`, and one
  // not later than the last, is passed over.
  bool step(const HandPlace& seen, std::vector<CodedStep>& out);
  // Returns the seconds for which the hand has stayed within one and a half steps of one place.
  double resting(double time) const;

  static constexpr double rest = 0.5, away = 0.5;   // seconds
  static constexpr float reach = 5, quickest = 12;  // shoulder widths, and a second

 private:
  bool started_ = false;
  double last_time_ = 0, anchor_time_ = 0, stay_time_ = 0;
  vec2 last_{0}, before_{0}, anchor_{0}, stay_{0};
};

// Return the steps of a path, one list for each motion; and its longest motion.
std::vector<std::vector<CodedStep>> code_motions(const HandPath& path);
std::vector<CodedStep> code_path(const HandPath& path);

}  // namespace wellspring::kiosk
