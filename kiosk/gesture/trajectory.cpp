// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/trajectory.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wellspring::kiosk {

namespace {

constexpr double never = -std::numeric_limits<double>::infinity();

bool may_end(const Hmm& model, int state) {
  return !model.ends_in_last || state == model.states - 1;
}

// Holds scaled forward and backward variables (Rabiner 1989, section V.A): row t of `alpha` has sum
// 1, `beta` is divided by the same scales.
struct Lattice {
  std::vector<double> alpha, beta, scale;
  double log_probability = 0;
};

bool run_forward(const Hmm& m, std::span<const Code> codes, Lattice& out) {
  const size_t n = size_t(m.states), length = codes.size();
  out.alpha.assign(n * length, 0);
  out.scale.assign(length, 0);
  out.log_probability = 0;
  for (size_t t = 0; t < length; t++) {
    double sum = 0;
    for (size_t j = 0; j < n; j++) {
      double p = 0;
      if (t == 0) p = m.initial[j];
      else
        for (size_t i = 0; i < n; i++) p += out.alpha[(t - 1) * n + i] * m.transition[i * n + j];
      p *= m.output[j][codes[t]];
      if (t + 1 == length && !may_end(m, int(j))) p = 0;
      out.alpha[t * n + j] = p;
      sum += p;
    }
    if (!(sum > 0)) return false;
    out.scale[t] = sum;
    out.log_probability += std::log(sum);
    for (size_t j = 0; j < n; j++) out.alpha[t * n + j] /= sum;
  }
  return true;
}

void run_backward(const Hmm& m, std::span<const Code> codes, Lattice& out) {
  const size_t n = size_t(m.states), length = codes.size();
  out.beta.assign(n * length, 0);
  for (size_t i = 0; i < n; i++)
    out.beta[(length - 1) * n + i] = may_end(m, int(i)) ? 1 / out.scale[length - 1] : 0;
  for (size_t t = length - 1; t-- > 0;)
    for (size_t i = 0; i < n; i++) {
      double p = 0;
      for (size_t j = 0; j < n; j++)
        p += m.transition[i * n + j] * m.output[j][codes[t + 1]] * out.beta[(t + 1) * n + j];
      out.beta[t * n + i] = p / out.scale[t];
    }
}

}  // namespace

Hmm make_banded(int states, std::span<const std::vector<Code>> sequences) {
  Hmm model;
  model.states = states;
  model.ends_in_last = true;
  model.initial.assign(size_t(states), 0);
  model.initial[0] = 1;
  model.transition.assign(size_t(states * states), 0);
  model.output.assign(size_t(states), {});
  double codes = 0;
  for (auto& row : model.output) row.fill(1);  // nothing is impossible before training
  for (const std::vector<Code>& sequence : sequences) {
    codes += double(sequence.size());
    for (size_t t = 0; t < sequence.size(); t++)
      model.output[t * size_t(states) / sequence.size()][sequence[t]]++;
  }
  const double stay = codes / double(std::max<size_t>(1, sequences.size())) / states;
  for (int i = 0; i < states; i++) {
    const bool last = i == states - 1;
    model.at(i, i) = last ? 1 : std::clamp(1 - 1 / stay, 0.1, 0.99);
    if (!last) model.at(i, i + 1) = 1 - model.at(i, i);
    double sum = 0;
    for (double p : model.output[size_t(i)]) sum += p;
    for (double& p : model.output[size_t(i)]) p /= sum;
  }
  return model;
}

double viterbi(const Hmm& m, std::span<const Code> codes, std::vector<int>* path) {
  const size_t n = size_t(m.states), length = codes.size();
  std::vector<double> delta(n), next(n);
  std::vector<int> from(path ? n * length : 0);
  for (size_t j = 0; j < n; j++)
    delta[j] = std::log(m.initial[j]) + std::log(m.output[j][codes[0]]);
  for (size_t t = 1; t < length; t++) {
    for (size_t j = 0; j < n; j++) {
      double best = never;
      int best_from = 0;
      for (size_t i = 0; i < n; i++) {
        const double p = delta[i] + std::log(m.transition[i * n + j]);
        if (p > best) best = p, best_from = int(i);
      }
      next[j] = best + std::log(m.output[j][codes[t]]);
      if (path) from[t * n + j] = best_from;
    }
    std::swap(delta, next);
  }
  int last = m.ends_in_last ? m.states - 1 : 0;
  for (int j = 0; j < m.states; j++)
    if (may_end(m, j) && delta[size_t(j)] > delta[size_t(last)]) last = j;
  if (path) {
    path->assign(length, last);
    for (size_t t = length - 1; t > 0; t--) (*path)[t - 1] = from[t * n + size_t((*path)[t])];
  }
  return delta[size_t(last)];
}

double improve(Hmm& m, std::span<const std::vector<Code>> sequences) {
  const size_t n = size_t(m.states);
  std::vector<double> starts(n), moves(n * n), left(n);
  std::vector<std::array<double, orientation_codes>> seen(n, {{}});
  Lattice lattice;
  double total = 0;
  for (const std::vector<Code>& codes : sequences) {
    if (codes.empty() || !run_forward(m, codes, lattice)) continue;
    run_backward(m, codes, lattice);
    total += lattice.log_probability;
    for (size_t t = 0; t < codes.size(); t++)
      for (size_t i = 0; i < n; i++) {
        const double here = lattice.alpha[t * n + i];
        const double gamma = here * lattice.beta[t * n + i] * lattice.scale[t];
        if (t == 0) starts[i] += gamma;
        seen[i][codes[t]] += gamma;
        if (t + 1 == codes.size()) continue;
        left[i] += gamma;
        for (size_t j = 0; j < n; j++)
          moves[i * n + j] += here * m.transition[i * n + j] * m.output[j][codes[t + 1]] *
                              lattice.beta[(t + 1) * n + j];
      }
  }
  double began = 0;
  for (double p : starts) began += p;
  for (size_t i = 0; i < n; i++) {
    if (began > 0) m.initial[i] = starts[i] / began;
    double sum = 0;
    for (double p : seen[i]) sum += p;
    if (sum > 0)
      for (size_t o = 0; o < orientation_codes; o++) m.output[i][o] = seen[i][o] / sum;
    if (left[i] > 0)
      for (size_t j = 0; j < n; j++) m.transition[i * n + j] = moves[i * n + j] / left[i];
  }
  return total;
}

void train(Hmm& model, std::span<const std::vector<Code>> sequences, int most, double least) {
  double last = never;
  for (int step = 0; step < most; step++) {
    const double now = improve(model, sequences);
    if (now - last < least * double(sequences.size())) break;
    last = now;
  }
}

void smooth_outputs(Hmm& model, double deviation) {
  for (auto& row : model.output) {
    std::array<double, orientation_codes> out{};
    double sum = 0;
    for (int from = 0; from < orientation_codes; from++)
      for (int to = 0; to < orientation_codes; to++) {
        const int around = std::abs(from - to);
        const double apart = std::min(around, orientation_codes - around) / deviation;
        const double p = row[size_t(from)] * std::exp(-0.5 * apart * apart);
        out[size_t(to)] += p;
        sum += p;
      }
    for (double& p : out) p /= sum;
    row = out;
  }
}

void raise_outputs(Hmm& model, double share) {
  for (auto& row : model.output)
    for (double& p : row) p = (1 - share) * p + share / orientation_codes;
}

Code orientation_code(vec2 step) {
  const float turns = std::atan2(step.y, step.x) / (2 * pi);
  const int code = int(std::lround(turns * orientation_codes));
  return Code((code + orientation_codes) % orientation_codes);
}

bool OrientationCoder::step(const HandPlace& seen, std::vector<CodedStep>& out) {
  const auto [time, place] = seen;
  const bool valid = std::isfinite(time) && std::isfinite(place.x) && std::isfinite(place.y) &&
                     std::abs(place.x) < reach && std::abs(place.y) < reach;
  if (!valid || (started_ && !(time > last_time_))) return false;
  const float passed = float(time - last_time_);
  if (!started_ || passed > away ||
      glm::length(place - last_) > quickest * std::max(passed, 0.05f)) {
    started_ = true;
    last_time_ = anchor_time_ = stay_time_ = time;
    last_ = before_ = anchor_ = stay_ = place;
    return true;
  }
  // The middle one of three places is smoothed by its neighbours (1, 2, 1): one frame late.
  const vec2 smooth = (before_ + 2.f * last_ + place) * 0.25f;
  const double smooth_time = last_time_;
  before_ = last_;
  last_ = place;
  last_time_ = time;
  const bool rested = smooth_time - stay_time_ > rest;
  if (glm::length(smooth - stay_) > 1.5f * code_step) {
    stay_ = smooth;
    stay_time_ = smooth_time;
  } else if (rested) return false;
  const float far = glm::length(smooth - anchor_);
  if (far < code_step) return false;
  // A hand that paused did not creep: it left just now.
  const double begin = std::max(anchor_time_, smooth_time - std::max(0.2, 1.0 * passed));
  const int steps = int(far / code_step);
  const vec2 one = (smooth - anchor_) / far * code_step;
  const double pace = (smooth_time - begin) * code_step / far;
  for (int i = 0; i < steps; i++) {
    out.push_back(
        {orientation_code(one), begin + i * pace, begin + (i + 1) * pace, anchor_, anchor_ + one});
    anchor_ += one;
  }
  anchor_time_ = begin + steps * pace;
  return rested;
}

double OrientationCoder::resting(double time) const { return started_ ? time - stay_time_ : 0; }

std::vector<std::vector<CodedStep>> code_motions(const HandPath& path) {
  OrientationCoder coder;
  std::vector<std::vector<CodedStep>> motions;
  std::vector<CodedStep> fresh;
  for (const HandPlace& seen : path.places) {
    fresh.clear();
    if (coder.step(seen, fresh) || motions.empty()) motions.emplace_back();
    motions.back().insert(motions.back().end(), fresh.begin(), fresh.end());
  }
  std::erase_if(motions, [](const auto& motion) { return motion.empty(); });
  return motions;
}

std::vector<CodedStep> code_path(const HandPath& path) {
  std::vector<CodedStep> longest;
  for (auto& motion : code_motions(path))
    if (motion.size() > longest.size()) longest = std::move(motion);
  return longest;
}

}  // namespace wellspring::kiosk
