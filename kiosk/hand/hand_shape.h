// SPDX-License-Identifier: Apache-2.0
// Tells from 21 landmarks which pose a hand has, how many fingers are stretched, where it is and
// where it points. Fingers are judged in three dimensions, so a hand may be turned any way.
#pragma once
#include <array>
#include <optional>

#include "kiosk/frame/head.h"
#include "kiosk/hand/hand_marks.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

struct HandShape {
  std::array<bool, 5> stretched{};  // from the thumb to the little finger
  HandPose pose = HandPose::other;
  int fingers = 0;
  bool upright = false;  // fingers that are stretched point up in the picture, as one counts
  float roll = 0;  // radians by which the palm is turned in the picture, clockwise; 0: upright
};
HandShape shape_of(const HandMarks& marks);

// Holds the place of a hand in the camera's frame, metres.
struct HandInSpace {
  vec3 palm{0}, index_root{0}, index_tip{0};
};
// Returns the place by the size of the palm as the network knows it in metres; nothing if that
// makes no sense. focal: pixels of a picture of that size.
std::optional<HandInSpace> place_hand(const HandMarks& marks, float focal, int width, int height);

// Returns where the ray from one point through another meets the screen's plane; both in the frame
// of the screen, metres. Nothing if it does not go to the screen, or meets it beyond `reach`.
inline constexpr float pointing_reach = 3;  // metres from the screen's centre
std::optional<vec2> point_on_screen(vec3 from, vec3 through);

}  // namespace wellspring::kiosk
