// SPDX-License-Identifier: Apache-2.0
// Finds gestures within continuous motion, frame by frame (forward spotting; Elmezain et al. 2009,
// section 3.3). From each place where one may begin all gestures and the model of other motion are
// followed; the difference of their ln probabilities is the differential observation probability.
// The paper's rule (begin where it becomes positive, end where it becomes negative) takes every
// straight line for the first stroke of a digit, so further rules hold:
//   - a gesture begins and ends where the hand turns, slows or rests (Kang, Lee, Jung 2004);
//   - the difference over the first `window` steps is positive;
//   - it ends in its last state, where difference and evidence (gesture_model.h) are largest;
//   - they exceed `margin` and what other motion reaches;
//   - only the clearest of overlapping gestures is reported, once none is ahead of it any more.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kiosk/gesture/gesture_model.h"

namespace wellspring::kiosk {

struct SpotSettings {
  int window = 5;        // steps
  double margin = 0.05;  // share of the gesture's usual difference and evidence
  double evidence = 1;   // weight of training's places, size and speed; 0: codes alone
  int least_steps = 5;   // shorter gestures are none: 0.3 shoulder widths
  int hold = 5;          // steps for which a gesture waits for a better one that overlaps it
};

struct SpottedGesture {
  std::string label;
  double begin = 0, end = 0;  // seconds
  double score = 0;           // nats above other motion
};

class GestureSpotter {
 public:
  // `models` is borrowed and must outlive this.
  explicit GestureSpotter(const GestureModels& models, const SpotSettings& settings = {});
  ~GestureSpotter();
  // Takes a frame with the hand's place as trajectory.h has it; without one while no hand is seen.
  // Returns a gesture when it is certain, a few steps or a rest after its end. Times must grow;
  // other values are passed over as OrientationCoder says. Memory does not grow.
  std::optional<SpottedGesture> step(double time, std::optional<vec2> place);
  size_t memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Returns all gestures that are spotted in a path, and in the second that follows it.
std::vector<SpottedGesture> spot_path(const GestureModels& models, const SpotSettings& settings,
                                      const HandPath& path);

}  // namespace wellspring::kiosk
