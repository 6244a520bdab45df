// SPDX-License-Identifier: Apache-2.0
// Follows faces from frame to frame, under a number each. A followed face is sought in a small
// window; the whole frame only now and then, for newcomers. A face that turns away is carried on
// for a moment by its own texture. Pictures of faces are followed, too (kiosk/face/liveness.h).
#pragma once
#include <memory>
#include <vector>

#include "kiosk/face/face_finder.h"
#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

// Finds whether something moves in front of the camera, and where. A background model of the empty
// room (Zivkovic's mixture of Gaussians, ICPR 2004) runs on a small picture whose brightness was
// first brought to that of the background, so lamps, clouds and the camera's own exposure are not
// taken for people. A region counts only if it both differs from the background and has changed
// within the last second: a bag left behind or a ghost of somebody gone does not.

struct MotionSettings {
  int width = 160;              // pixels of the working picture's longer side
  double adapt = 15;            // seconds until a changed background is believed
  float moving_share = 0.015f;  // share of the picture; less is not motion
  // share of the picture; more at once is a change of light: the background starts anew
  float light_share = 0.7f;
};

struct Motion {
  float share = 0;      // share of the picture that belongs to moving regions, 0 to 1
  bool moving = false;  // share >= moving_share
  bool light_changed = false;
  std::vector<Box> zones;  // boxes in the frame, largest first, at most 4
};

class MotionWatch {
 public:
  explicit MotionWatch(const MotionSettings& settings = {});
  ~MotionWatch();
  // Takes a frame, about 1 ms. Frames may change size; the background then starts anew.
  Motion step(const GrayFrame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

struct PeopleSettings {
  double search_alone = 0.1;  // seconds between searches of the frame while nobody is followed
  double search_more = 0.5;   // the same while somebody is followed
  double thorough = 0.6;      // the same with the slower detector, while nobody is followed
  double thorough_more = 2;   // the same while somebody is followed and something moves
  double carry = 1.2;         // seconds a face is carried on by texture alone
  double recall = 4;          // seconds after which a lost face's number is forgotten
  int most = 6;               // faces followed at once
};

struct Followed {
  uint32_t id = 0;
  Face face;
  bool seen = false;     // a detector saw it in this frame
  bool visible = false;  // seen or carried on
  double seen_time = 0;
  int hits = 0;  // frames in which a detector saw it
};

class People {
 public:
  // `finder` is borrowed and must outlive this.
  explicit People(FaceFinder& finder, const PeopleSettings& settings = {});
  ~People();
  // Takes a frame after motion.step(frame). The result is nearest (largest) first.
  const std::vector<Followed>& step(const GrayFrame& frame, const Motion& motion);
  // Sets how far that head is tilted, radians, for the next frame's search (FaceFinder::follow).
  void tilt(uint32_t id, float roll);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
