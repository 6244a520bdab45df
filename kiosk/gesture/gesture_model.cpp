// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/gesture_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wellspring::kiosk {

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Code> codes_of(std::span<const CodedStep> steps) {
  std::vector<Code> codes;
  for (const CodedStep& step : steps) codes.push_back(step.code);
  return codes;
}

// Finds where the best path enters each state; empty if there is no path.
std::vector<int> find_entries(const Hmm& hmm, std::span<const Code> codes, double& score) {
  std::vector<int> path, entries;
  if (int(codes.size()) < hmm.states) return {};
  score = viterbi(hmm, codes, &path);
  if (!std::isfinite(score)) return {};
  for (int t = 0; t < int(path.size()); t++)
    if (t == 0 || path[size_t(t)] != path[size_t(t - 1)]) entries.push_back(t);
  return int(entries.size()) == hmm.states ? entries : std::vector<int>();
}

double dwell_after(const HandPath& path, std::span<const CodedStep> steps) {
  return path.places.back().time - steps.back().end;
}

std::vector<double> measure_motion(std::span<const CodedStep> steps, std::span<const int> entries) {
  const double length = code_step * double(steps.size());
  std::vector<double> out;
  for (size_t j = 0; j < entries.size(); j++) {
    const size_t end = j + 1 < entries.size() ? size_t(entries[j + 1]) : steps.size();
    const vec2 went = steps[end - 1].to - steps[size_t(entries[j])].from;
    out.push_back(went.x / length);
    out.push_back(went.y / length);
  }
  std::vector<double> times;
  for (const CodedStep& step : steps) times.push_back(std::max(1e-3, step.end - step.begin));
  const double seconds = std::accumulate(times.begin(), times.end(), 0.0);
  out.push_back(std::log(length));
  out.push_back(std::log(seconds));
  out.push_back(std::log(code_step / median(times)));
  out.push_back(steps.front().from.y);
  out.push_back(steps.back().to.y);
  out.push_back(glm::length(steps.back().to));
  constexpr size_t edge = 3;  // steps
  const size_t few = std::min(edge, steps.size());
  const double first = steps[few - 1].end - steps.front().begin;
  const double last = steps.back().end - steps[steps.size() - few].begin;
  const double usual = seconds * double(few) / double(steps.size());
  out.push_back(std::log(usual / std::max(1e-3, first)));
  out.push_back(std::log(usual / std::max(1e-3, last)));
  return out;
}

double eval_evidence(const GestureModel& model, std::span<const double> measures) {
  double sum = 0;
  for (size_t k = 0; k < measures.size(); k++) {
    const double z = (measures[k] - model.mean[k]) / model.deviation[k];
    const double other = (measures[k] - model.other_mean[k]) / model.other_deviation[k];
    // Beyond one deviation the other motions count as spread evenly, since their training has next
    // to nothing there.
    sum += 0.5 * (std::min(1.0, other * other) - z * z) +
           std::max(0.0, std::log(model.other_deviation[k] / model.deviation[k]));
  }
  return sum;
}

std::string recognise(const GestureModels& models, const HandPath& path, double evidence) {
  const std::vector<CodedStep> steps = code_path(path);
  if (steps.empty()) return {};
  const std::vector<Code> codes = codes_of(steps);
  double best = -INFINITY;
  std::string label;
  for (const GestureModel& model : models.gestures) {
    if (dwell_after(path, steps) < model.dwell) continue;
    double score = 0;
    const std::vector<int> entries = find_entries(model.hmm, codes, score);
    if (entries.empty()) continue;
    if (evidence > 0) score += evidence * eval_evidence(model, measure_motion(steps, entries));
    if (score > best) best = score, label = model.label;
  }
  return label;
}

}  // namespace wellspring::kiosk
