// SPDX-License-Identifier: Apache-2.0
// Follows the hand of somebody whose face is followed. Skin has the colour of the face: a Gaussian
// over Cb and Cr that follows the light. A hand is a region of skin that moves within the arms'
// reach and is not the head; mean shift then follows it (skin.h) until the region no longer
// looks like it. One hand is followed, the one that moved first. Neither a depth map nor a network
// is needed; short sleeves are a hard case: a bare forearm looks like a hand.
#pragma once
#include <memory>
#include <optional>

#include "kiosk/gesture/skin.h"

namespace wellspring::kiosk {

struct HeadInView {
  vec2 center{0};  // centre of the face, pixels of the view
  float side = 0;  // side of the square round the face; 0.18 m in adults
};

// Shoulders are 0.41 m wide in the mean.
inline constexpr float shoulder_width = 2.3f;  // face sides

struct HandSeen {
  vec2 pixel{0};
  vec2 place{0};         // as trajectory.h has it
  float similarity = 0;  // 0 to 1
  int iterations = 0;    // number of mean shift's iterations
};

class HandTracker {
 public:
  // `mirrored`: the view is a mirror image.
  explicit HandTracker(bool mirrored = false);
  ~HandTracker();
  // Takes a frame, about 2 ms for 320x240. Views may change size; the hand is then sought anew.
  // Nothing is found in a view that is empty or if the head has no size.
  std::optional<HandSeen> step(const ColorView& view, const HeadInView& head, double time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
