// SPDX-License-Identifier: Apache-2.0
#include "kiosk/gesture/train.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "kiosk/gesture/spot.h"

namespace wellspring::kiosk {

namespace {

using Row = std::array<double, orientation_codes>;

// This is a state, with the number of states it was merged from.
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

namespace {

constexpr double false_a_minute = 3;  // all gestures, in other motion of the training set
constexpr double floor_share = 0.01;  // share of all outputs, spread over all codes
// No measure is trusted to deviate less than this: training sets are small.
constexpr double least_deviation = 0.03;      // displacements over length
constexpr double least_log_deviation = 0.15;  // length and speed
constexpr double least_height_deviation = 0.2;
constexpr double least_edge_deviation = 0.4;  // speed at begin and end

// Counts straight pieces of the polygon between two steps (Douglas and Peucker 1973).
int count_pieces(std::span<const CodedStep> steps, float tolerance) {
  const vec2 a = steps.front().from, b = steps.back().to;
  const float length = glm::length(b - a);
  float worst = 0;
  size_t at = 0;
  for (size_t i = 0; i + 1 < steps.size(); i++) {
    const vec2 p = steps[i].to - a;
    const float along =
        length > 0 ? std::clamp(glm::dot(p, b - a) / (length * length), 0.f, 1.f) : 0;
    const float away = glm::length(p - along * (b - a));
    if (away > worst) worst = away, at = i + 1;
  }
  if (worst <= tolerance) return 1;
  return count_pieces(steps.first(at), tolerance) + count_pieces(steps.subspan(at), tolerance);
}

int states_of(std::span<const std::vector<CodedStep>> paths) {
  std::vector<int> pieces;
  for (const auto& steps : paths) {
    vec2 low = steps[0].from, high = low;
    for (const CodedStep& step : steps)
      low = glm::min(low, step.to), high = glm::max(high, step.to);
    pieces.push_back(count_pieces(steps, 0.12f * glm::length(high - low)));
  }
  std::nth_element(pieces.begin(), pieces.begin() + ptrdiff_t(pieces.size() / 2), pieces.end());
  return std::clamp(pieces[pieces.size() / 2], least_states, most_states);
}

using Paths = std::vector<std::vector<CodedStep>>;

// Learns mean and deviation of each measure of `paths`; a deviation is never below its floor. False
// if fewer than three of them can be this gesture at all.
bool learn_measures(const Hmm& hmm, const Paths& paths, std::vector<double>& mean,
                    std::vector<double>& deviation) {
  const size_t count = count_measures(hmm.states);
  std::vector<double> sum(count), squares(count);
  int seen = 0;
  for (const auto& steps : paths) {
    double score = 0;
    const std::vector<int> entries = find_entries(hmm, codes_of(steps), score);
    if (entries.empty()) continue;
    const std::vector<double> measures = measure_motion(steps, entries);
    for (size_t k = 0; k < count; k++)
      sum[k] += measures[k], squares[k] += measures[k] * measures[k];
    seen++;
  }
  if (seen < 3) return false;
  mean.assign(count, 0);
  deviation.assign(count, 0);
  for (size_t k = 0; k < count; k++) {
    const size_t left = count - k;
    const double least = left > 8   ? least_deviation
                         : left > 5 ? least_log_deviation
                         : left > 2 ? least_height_deviation
                                    : least_edge_deviation;
    mean[k] = sum[k] / seen;
    const double variance = squares[k] / seen - mean[k] * mean[k];
    deviation[k] = std::max(least, std::sqrt(std::max(0.0, variance)));
  }
  return true;
}

Hmm make_other(std::span<const GestureModel> gestures, const NonGestureSettings& settings) {
  std::vector<Hmm> hmms;
  std::vector<double> last_stay;
  for (const GestureModel& gesture : gestures) {
    const size_t n = size_t(gesture.hmm.states);
    // `last` gives the length of the last state's piece, in codes of the mean motion.
    const vec2 last(float(gesture.mean[2 * n - 2]), float(gesture.mean[2 * n - 1]));
    last_stay.push_back(double(glm::length(last)) * std::exp(gesture.mean[2 * n]) / code_step);
    hmms.push_back(gesture.hmm);
  }
  return make_non_gesture(hmms, last_stay, settings);
}

void learn_usual(GestureModel& model, const Hmm& other, const Paths& paths) {
  std::vector<double> differences, evidence;
  for (const auto& steps : paths) {
    const std::vector<Code> codes = codes_of(steps);
    double score = 0;
    const std::vector<int> entries = find_entries(model.hmm, codes, score);
    if (entries.empty()) continue;
    differences.push_back(score - viterbi(other, codes));
    evidence.push_back(eval_evidence(model, measure_motion(steps, entries)));
  }
  model.usual_difference = median(differences);
  model.usual_evidence = median(evidence);
}

GestureModel train_gesture(std::span<const HandPath* const> recordings) {
  GestureModel model;
  model.label = recordings[0]->label;
  model.variant = recordings[0]->variant;
  Paths paths;
  std::vector<std::vector<Code>> codes;
  std::vector<double> dwells;
  for (const HandPath* recording : recordings) {
    std::vector<CodedStep> steps = code_path(*recording);
    if (int(steps.size()) < most_states) continue;
    codes.push_back(codes_of(steps));
    dwells.push_back(dwell_after(*recording, steps));
    paths.push_back(std::move(steps));
  }
  if (paths.empty()) return model;
  model.hmm = make_banded(states_of(paths), codes);
  train(model.hmm, codes);
  smooth_outputs(model.hmm, 0.5);  // some people tilt their hand
  raise_outputs(model.hmm, floor_share);
  learn_measures(model.hmm, paths, model.mean, model.deviation);
  // A rest belongs to the gesture if nearly everybody made one.
  std::nth_element(dwells.begin(), dwells.begin() + ptrdiff_t(dwells.size() / 20), dwells.end());
  const double dwell = dwells[dwells.size() / 20];
  model.dwell = dwell > 1.2 * OrientationCoder::rest ? 0.8 * dwell : 0;
  return model;
}

// Sets each model's `least`: other motion of the training set may reach it only so often.
void learn_least(GestureModels& models, std::span<const HandPath> paths) {
  double minutes = 0;
  std::map<std::string, std::vector<double>> scores;
  for (const HandPath& path : paths) {
    if (!path.label.empty() || path.places.empty()) continue;
    minutes += (path.places.back().time - path.places.front().time) / 60;
    for (const SpottedGesture& found : spot_path(models, {}, path))
      scores[found.label].push_back(found.score);
  }
  const size_t allowed = size_t(minutes * false_a_minute / double(models.gestures.size()));
  for (auto& [label, found] : scores) {
    if (found.size() <= allowed) continue;
    std::sort(found.rbegin(), found.rend());
    for (GestureModel& model : models.gestures)
      if (model.label == label) model.least = found[allowed];
  }
}

}  // namespace

GestureModels train_gestures(std::span<const HandPath> paths, const NonGestureSettings& settings) {
  std::map<std::pair<std::string, std::string>, std::vector<const HandPath*>> groups;
  for (const HandPath& path : paths)
    if (!path.label.empty() && !path.places.empty())
      groups[{path.label, path.variant}].push_back(&path);
  GestureModels models;
  for (const auto& [name, group] : groups)
    if (GestureModel model = train_gesture(group); !model.mean.empty())
      models.gestures.push_back(std::move(model));
  if (models.gestures.empty()) return models;
  models.other = make_other(models.gestures, settings);
  for (GestureModel& model : models.gestures) {
    Paths own, others;
    for (const HandPath& path : paths) {
      if (path.label.empty()) continue;
      if (path.label != model.label)
        for (auto& motion : code_motions(path)) others.push_back(std::move(motion));
      else if (path.variant == model.variant) own.push_back(code_path(path));
    }
    // A single gesture has no other one to differ from.
    if (!learn_measures(model.hmm, others, model.other_mean, model.other_deviation))
      model.other_mean = model.mean, model.other_deviation = model.deviation;
    learn_usual(model, models.other, own);
  }
  learn_least(models, paths);
  return models;
}

}  // namespace wellspring::kiosk
