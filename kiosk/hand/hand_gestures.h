// SPDX-License-Identifier: Apache-2.0
// Spots what one hand does over time from its pose and place, beside what kiosk/gesture spots in a
// path. Names:
//   stop                    an open palm is shown to the screen and held still
//   1 .. 4                  so many fingers are held up, still: the same as the digit in the air
//   swipe_left, swipe_right an open hand moves fast to that side, as the visitor sees it
//   turn_left, turn_right   a hand closes and turns about its arm, counterclockwise or clockwise as
//                           the visitor sees it
#pragma once
#include <deque>
#include <string>

#include "kiosk/hand/hand_shape.h"

namespace wellspring::kiosk {

class HandGestures {
 public:
  // Takes a frame: shape and palm, the latter in the frame of the screen, metres. `clockwise`: the
  // roll of the palm as the visitor sees it, radians. Returns the gesture that is certain now, else
  // an empty text. A time that runs backwards, or a gap of more than half a second, begins anew.
  std::string step(double time, const HandShape& shape, vec3 palm, float clockwise);
  // Notes that the hand is away.
  void forget();

  static constexpr double held = 0.7;     // seconds for which a palm or fingers are shown
  static constexpr float still = 0.25f;   // metres a second that a hand at rest may move
  static constexpr float swiped = 0.22f;  // metres to the side within `swipe_time`
  static constexpr double swipe_time = 0.45;
  static constexpr float turned = 0.6f;     // radians of a turn that count
  static constexpr double turn_time = 1.5;  // seconds within which a closed hand turns so far

 private:
  struct Moment {
    double time;
    vec3 palm;
    HandPose pose;
    int fingers;
    float roll;
  };
  std::string held_sign(double time);
  std::string swipe() const;
  std::string turn() const;

  std::deque<Moment> moments_;  // those of the last seconds
  bool told_ = false;           // the sign that is held was told
  double told_at_ = -1e9;       // when a motion was told: what follows is its way back
};

}  // namespace wellspring::kiosk
