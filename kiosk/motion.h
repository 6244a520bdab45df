// SPDX-License-Identifier: Apache-2.0
// Is something moving in front of the camera, and where? A background model of the empty room
// (Zivkovic's mixture of Gaussians, ICPR 2004) on a small picture whose brightness was first
// brought to that of the background, so lamps, clouds and the camera's own exposure are not taken
// for people. A region counts only if it both differs from the background and has changed within
// the last second: a bag left behind or a ghost of somebody gone does not.
#pragma once
#include <memory>
#include <vector>

#include "kiosk/frame/gray_frame.h"

namespace wellspring::kiosk {

struct MotionSettings {
  int width = 160;              // pixels of the working picture's longer side
  double adapt = 15;            // seconds until a changed background is believed
  float moving_share = 0.015f;  // of the picture: less is not motion
  float light_share = 0.7f;     // more at once is a change of light: the background starts anew
};

struct Motion {
  float share = 0;      // of the picture that belongs to moving regions, 0 to 1
  bool moving = false;  // share >= moving_share
  bool light_changed = false;
  std::vector<Box> zones;  // of the frame, largest first, at most 4
};

class MotionWatch {
 public:
  explicit MotionWatch(const MotionSettings& settings = {});
  ~MotionWatch();
  // Called once a frame, about 1 ms. Frames may change size; the background then starts anew.
  Motion step(const GrayFrame& frame);
  // Share of `box` (of the frame last seen) that changed from one frame to the next, 0 to 1.
  float changed(const Box& box) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
