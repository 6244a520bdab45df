// SPDX-License-Identifier: Apache-2.0
// Turns recorded movements into models of gestures (Elmezain et al. 2009, sections 3.1 and 3.2).
#pragma once
#include <span>

#include "kiosk/gesture/gesture_model.h"
#include "kiosk/gesture/trajectory.h"

namespace wellspring::kiosk {

// Makes the model of all motion that is no gesture: all states of all gestures, each reachable from
// each (Elmezain et al. 2009, section 3.2; Lee and Kim 1999). A gesture is likelier under its own
// model, any other motion under this one, so it is a threshold that fits itself.

struct NonGestureSettings {
  double smoothing = 1;  // standard deviation of the filter over outputs, codes
  int states = 24;       // similar states are merged until so many are left
};

// Copies the states with their outputs smoothed round the circle of codes, merges them, and joins
// them by equation 9: a_ij = (1 - a_ii) / (N - 1). The start state leads to all of them alike, each
// leads to the end state; both take no time and show no code. A gesture's last state, which is
// never left in its own model, stays as long here as `last_stay` says, codes in the mean.
Hmm make_non_gesture(std::span<const Hmm> gestures, std::span<const double> last_stay,
                     const NonGestureSettings& settings = {});

// Applies equation 9 to the self-transitions; one state keeps itself.
void join_states(Hmm& model);

// Returns the relative entropy both ways, nats: 0 for equal rows.
double divergence(const std::array<double, orientation_codes>& a,
                  const std::array<double, orientation_codes>& b);

// Trains a model for each label and variant by Baum-Welch, with one state for each straight piece
// of the motion, 3 to 5. `paths` hold one gesture each, or without a label any other motion, which
// decides how clear a gesture must be. Gestures with fewer than three paths of five steps are left
// out.
GestureModels train_gestures(std::span<const HandPath> paths,
                             const NonGestureSettings& settings = {});

}  // namespace wellspring::kiosk
