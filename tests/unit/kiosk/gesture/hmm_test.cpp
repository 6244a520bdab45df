// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "kiosk/gesture/train.h"

namespace wellspring::test {
namespace {

void fill(Rng& rng, double* row, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += row[i] = 0.05 + double(rng.uniform());
  for (size_t i = 0; i < count; i++) row[i] /= sum;
}

Hmm random_model(int states, uint64_t seed) {
  Rng rng(seed);
  Hmm m{.states = states};
  m.initial.resize(size_t(states));
  m.transition.resize(size_t(states * states));
  m.output.resize(size_t(states));
  fill(rng, m.initial.data(), m.initial.size());
  for (int i = 0; i < states; i++) {
    fill(rng, &m.at(i, 0), size_t(states));
    fill(rng, m.output[size_t(i)].data(), orientation_codes);
  }
  return m;
}

std::vector<Code> random_codes(Rng& rng, size_t length) {
  std::vector<Code> codes;
  for (size_t t = 0; t < length; t++) codes.push_back(Code(rng.next() % orientation_codes));
  return codes;
}

// The best and the summed probability over all paths, one by one.
struct Enumerated {
  double best = 0, sum = 0;
  std::vector<int> path;
};
Enumerated enumerate(const Hmm& m, const std::vector<Code>& codes) {
  Enumerated out;
  std::vector<int> path(codes.size());
  const long all = std::lround(std::pow(m.states, double(codes.size())));
  for (long n = 0; n < all; n++) {
    long rest = n;
    for (int& state : path) state = int(rest % m.states), rest /= m.states;
    if (m.ends_in_last && path.back() != m.states - 1) continue;
    double p = 1;
    for (size_t t = 0; t < codes.size(); t++)
      p *= (t == 0 ? m.initial[size_t(path[0])] : m.at(path[t - 1], path[t])) *
           m.output[size_t(path[t])][codes[t]];
    out.sum += p;
    if (p > out.best) out.best = p, out.path = path;
  }
  return out;
}

// ln P(codes), as training has it.
double forward_probability(Hmm model, const std::vector<Code>& codes) {
  return improve(model, std::vector<std::vector<Code>>{codes});
}

TEST(Hmm, viterbi_and_the_forward_procedure_agree_with_all_paths_one_by_one) {
  Rng rng(3);
  for (int trial = 0; trial < 20; trial++) {
    Hmm m = random_model(2 + trial % 3, 100 + uint64_t(trial));
    m.ends_in_last = trial % 2;
    const std::vector<Code> codes = random_codes(rng, 1 + size_t(trial % 6));
    const Enumerated truth = enumerate(m, codes);
    std::vector<int> path;
    EXPECT_NEAR(viterbi(m, codes, &path), std::log(truth.best), 1e-9);
    EXPECT_EQ(path, truth.path);
    EXPECT_NEAR(forward_probability(m, codes), std::log(truth.sum), 1e-9);
  }
}

TEST(Hmm, long_sequences_do_not_underflow) {
  const Hmm m = random_model(4, 8);
  Rng rng(9);
  const std::vector<Code> codes = random_codes(rng, 5000);
  const double forward = forward_probability(m, codes);
  EXPECT_TRUE(std::isfinite(forward));
  EXPECT_LT(viterbi(m, codes), forward);
}

TEST(Hmm, what_a_banded_model_cannot_make_has_no_probability) {
  const std::vector<std::vector<Code>> taught{{0, 0, 4, 4, 9, 9}};
  const Hmm m = make_banded(3, taught);
  EXPECT_EQ(viterbi(m, std::vector<Code>{0, 4}), -INFINITY);  // too short for three states
  EXPECT_TRUE(std::isfinite(viterbi(m, std::vector<Code>{0, 4, 9})));
}

TEST(Hmm, baum_welch_never_makes_the_training_set_less_likely) {
  for (bool ends_in_last : {false, true}) {
    Hmm m = random_model(3, 77);
    m.ends_in_last = ends_in_last;
    Rng rng(5);
    std::vector<std::vector<Code>> sequences;
    for (int i = 0; i < 12; i++) sequences.push_back(random_codes(rng, 4 + size_t(i)));
    double last = -INFINITY;
    for (int step = 0; step < 25; step++) {
      const double now = improve(m, sequences);
      EXPECT_GE(now, last - 1e-9) << step;
      last = now;
      for (int i = 0; i < m.states; i++) {
        double row = 0, outputs = 0;
        for (int j = 0; j < m.states; j++) row += m.at(i, j);
        for (double p : m.output[size_t(i)]) outputs += p;
        EXPECT_NEAR(row, 1, 1e-9);
        EXPECT_NEAR(outputs, 1, 1e-9);
      }
    }
  }
}

TEST(Hmm, training_recovers_the_model_that_made_the_sequences) {
  // Three states in a band, each with an output of its own; 400 sequences.
  Rng rng(21);
  const Code sign[3] = {2, 8, 14};
  std::vector<std::vector<Code>> sequences(400);
  for (auto& sequence : sequences)
    for (int state = 0; state < 3; state++) do
        sequence.push_back(rng.uniform() < 0.9f ? sign[state] : Code((sign[state] + 1) % 18));
      while (rng.uniform() < 0.8f);
  Hmm m = make_banded(3, sequences);
  train(m, sequences);
  for (int i = 0; i < 3; i++) {
    EXPECT_NEAR(m.output[size_t(i)][sign[i]], 0.9, 0.02) << i;
    if (i < 2) {
      EXPECT_NEAR(m.at(i, i), 0.8, 0.03) << i;
    }
  }
}

TEST(Hmm, smoothing_goes_round_the_circle_and_keeps_the_sum) {
  const std::vector<std::vector<Code>> taught{{0, 0, 0, 0}};
  Hmm m = make_banded(1, taught);
  m.output[0].fill(0);
  m.output[0][0] = 1;
  smooth_outputs(m, 1);
  EXPECT_NEAR(m.output[0][1] / m.output[0][0], std::exp(-0.5), 1e-9);
  EXPECT_DOUBLE_EQ(m.output[0][17], m.output[0][1]);
  double sum = 0;
  for (double p : m.output[0]) sum += p;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(NonGesture, equation_9_joins_all_states_and_keeps_the_stays) {
  const std::vector<std::vector<Code>> one{{0, 0, 0, 5, 5, 5}}, two{{9, 9, 13, 13, 13, 13}};
  const std::vector<Hmm> gestures{make_banded(2, one), make_banded(2, two)};
  const std::vector<double> last_stay{3, 4};
  NonGestureSettings settings{.states = 4};
  const Hmm m = make_non_gesture(gestures, last_stay, settings);
  ASSERT_EQ(m.states, 4);
  const double stays[4] = {gestures[0].at(0, 0), 1 - 1.0 / 3, gestures[1].at(0, 0), 0.75};
  for (int i = 0; i < 4; i++) {
    EXPECT_DOUBLE_EQ(m.at(i, i), stays[i]);
    EXPECT_DOUBLE_EQ(m.initial[size_t(i)], 0.25);
    for (int j = 0; j < 4; j++)
      if (i != j) {
        EXPECT_NEAR(m.at(i, j), (1 - stays[i]) / 3, 1e-12);
      }
  }
}

TEST(NonGesture, a_single_state_keeps_itself) {
  const std::vector<std::vector<Code>> one{{3, 3, 3}};
  const std::vector<Hmm> gestures{make_banded(1, one)};
  const Hmm m = make_non_gesture(gestures, std::vector<double>{3});
  ASSERT_EQ(m.states, 1);
  EXPECT_DOUBLE_EQ(m.at(0, 0), 1);
}

TEST(NonGesture, the_most_similar_states_are_merged_first) {
  const std::vector<std::vector<Code>> one{{0, 0, 0, 9, 9, 9}}, two{{1, 1, 1, 5, 5, 5}};
  const std::vector<Hmm> gestures{make_banded(2, one), make_banded(2, two)};
  NonGestureSettings settings{.states = 3};
  const Hmm m = make_non_gesture(gestures, std::vector<double>{3, 3}, settings);
  ASSERT_EQ(m.states, 3);
  EXPECT_NEAR(m.output[0][0], m.output[0][1], 1e-9);  // codes 0 and 1 share a state
  EXPECT_GT(divergence(m.output[1], m.output[2]), divergence(m.output[1], m.output[1]));
  EXPECT_DOUBLE_EQ(divergence(m.output[0], m.output[1]), divergence(m.output[1], m.output[0]));
}

}  // namespace
}  // namespace wellspring::test
