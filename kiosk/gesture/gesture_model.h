// SPDX-License-Identifier: Apache-2.0
// Holds the models of the kiosk's gestures: a hidden Markov model of each, its evidence besides the
// order of directions, and the model of all other motion.
//
// Codes hold directions alone, neither places nor speed (Elmezain et al. 2009, section 4.2), so
// half a digit and a way between two digits look like gestures. The best path's measures in each
// state are therefore compared with training afterwards, as Rabiner (1989, section IV.D) does with
// durations: how far the hand went in each state, and how large, quick and high the motion was.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "kiosk/gesture/trajectory.h"

namespace wellspring::kiosk {

inline constexpr int least_states = 3, most_states = 5;

struct GestureModel {
  std::string label, variant;
  Hmm hmm;
  std::vector<double> mean, deviation;              // measure_motion() in training
  std::vector<double> other_mean, other_deviation;  // the same for other gestures' motions
  // Medians over the training set, nats: how much likelier a motion is under this model than under
  // the model of other motion, and eval_evidence().
  double usual_difference = 0, usual_evidence = 0;
  double least = 0;  // nats that a motion must exceed to count, since other motion reaches them
  double dwell = 0;  // seconds that the hand must rest afterwards
};

struct GestureModels {
  std::vector<GestureModel> gestures;
  Hmm other;
};

// Measures steps whose best path enters state i at steps[entries[i]]. For each state there is its
// displacement over the length of all (right, down). Then come ln of the length in shoulder widths,
// ln of its seconds, ln of the median speed in shoulder widths a second, how far below the face the
// motion begins and ends, how far from the face it ends, and ln of the speed over its mean in the
// first and the last three steps: hands slow where a gesture begins and ends, not within a straight
// way. All states must have been entered, in order.
inline constexpr size_t count_measures(int states) { return size_t(2 * states + 8); }
std::vector<double> measure_motion(std::span<const CodedStep> steps, std::span<const int> entries);

// Returns how much likelier the measures are in this gesture than in another gesture, nats, with
// normal distributions for both.
double eval_evidence(const GestureModel& model, std::span<const double> measures);

// Return the orientation codes of steps, and where the best path through them enters each state of
// the model; no entries if there is no path. `score` is the path's ln probability.
std::vector<Code> codes_of(std::span<const CodedStep> steps);
std::vector<int> find_entries(const Hmm& hmm, std::span<const Code> codes, double& score);

// Returns the seconds of a path after its motion.
double dwell_after(const HandPath& path, std::span<const CodedStep> steps);
double median(std::vector<double> values);  // 0 for no values

// Recognises an isolated gesture, which the whole path is; empty if no model can make it.
std::string recognise(const GestureModels& models, const HandPath& path, double evidence = 1);

}  // namespace wellspring::kiosk
