// SPDX-License-Identifier: Apache-2.0
// Who is there: faces followed from frame to frame under a number each. A followed face is sought
// in a small window; the whole frame only now and then, for newcomers. A face that turns away is
// carried on for a moment by its own texture. A face that never stirs is a picture on the wall and
// does not count as a person.
#pragma once
#include <memory>
#include <vector>

#include "kiosk/face/face.h"
#include "kiosk/motion.h"

namespace wellspring::kiosk {

struct PeopleSettings {
  double search_alone = 0.1;  // seconds between searches of the frame while nobody is followed
  double search_more = 0.5;   // ... while somebody is
  double thorough = 0.6;      // ... with the slower detector, while nobody is followed
  double thorough_more = 2;   // ... while somebody is and something moves
  double carry = 1.2;         // seconds a face is carried on by texture alone
  double recall = 4;          // seconds after which a lost face's number is forgotten
  double still = 20;          // seconds without any movement: a picture
  int most = 6;               // faces followed at once
};

struct Followed {
  uint32_t id = 0;
  Face face;
  bool seen = false;     // in this frame, by a detector
  bool visible = false;  // seen or carried on
  bool picture = false;  // has not stirred for too long
  double first_time = 0, seen_time = 0, moved_time = 0;
  int hits = 0;  // frames in which a detector saw it
};

class People {
 public:
  // `finder` is borrowed and must outlive this.
  explicit People(FaceFinder& finder, const PeopleSettings& settings = {});
  ~People();
  // Called once a frame after motion.step(frame). The result is nearest (largest) first.
  const std::vector<Followed>& step(const GrayFrame& frame, const Motion& motion,
                                    const MotionWatch& watch);
  // How far that head is tilted, radians, for the next frame's search (FaceFinder::follow).
  void tilt(uint32_t id, float roll);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
