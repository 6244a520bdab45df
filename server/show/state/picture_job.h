// SPDX-License-Identifier: Apache-2.0
// What a picture is to be, decided before it is drawn (show/draw/picture.h).
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "light/dynamic/dynamic_light.h"
#include "world/view.h"

namespace wellspring::show {

// What of a visitor's rest, since the view or the light last changed, reconstructions depend on.
struct RestState {
  uint64_t asked = 0;         // samples of the view's sequence (picture/still/plan_still.h)
  double samples = 0;         // a pixel, that are kept
  double passed_samples = 0;  // of these, in the last pass
  double passed_at = -1e9, passed_seconds = 0;  // show time of its end; what it took
  bool reconstructed = false;                   // its picture is the one shown
};

// All that a picture's drawing depends on besides the world and what the visitor's cache remembers.
struct PictureJob {
  double time = 0;  // of the tick that ordered it
  uint64_t time_us = 0, tick = 0;
  View expected;              // what the visitor will see when it is shown
  View view;                  // drawn: that, and some around
  View ahead;                 // in the picture after that, when answers to its requests are shown
  uint32_t seq = 0;           // of the visitor's last input
  uint32_t camera_cuts = 0;   // of the visitor, by then
  bool still = false;         // without motion for a moment
  bool moving = false;        // something that can move may be in it
  bool learns = false;        // its samples are kept for each pixel, for reconstructions
  bool reconstruct = false;   // it becomes a reconstruction instead of being shown
  bool samples_only = false;  // nothing is drawn
  bool settled = false;       // for long: the reference takes over
  bool passing = false;       // drawn for a moment, and some around (picture/compose_drawn.h)
  RestState rest;             // of the visitor, by then
  float scale = 1;            // sides of its view, in pixels, over those of the visitor's picture
  bool attention = true;
  std::shared_ptr<const std::vector<float>> weights;  // of objects; null: all are 1
  bool note_seen = false;                             // for the next of these
  bool keep = false;                                  // as a keyframe, for others to be made of
  uint64_t seed = 0;
  std::optional<View>
      around;  // of a quick turn: what else may be asked for; drawn before, in fewer pixels
  int samples = 0;
  DynamicLights dynamic;  // as they are then
};

// It is drawn in steps, between which the world may move and what moves be drawn.
inline bool in_steps(const PictureJob& job) { return job.still && job.keep; }

}  // namespace wellspring::show
