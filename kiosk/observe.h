// SPDX-License-Identifier: Apache-2.0
// One frame in, one observation out: motion, faces, heads, presence, in that order. What leaves is
// numbers.
#pragma once
#include <memory>

#include "kiosk/face.h"
#include "kiosk/head.h"
#include "kiosk/motion.h"
#include "kiosk/people.h"
#include "kiosk/presence.h"
#include "wire/messages.h"

namespace wellspring {

struct ObserverSettings {
  Mount mount;
  FaceSettings face;
  MotionSettings motion;
  PeopleSettings people;
  PresenceSettings presence;
};

class Observer {
 public:
  // Throws LoadError when a cascade is missing.
  explicit Observer(const ObserverSettings& settings = {});
  ~Observer();
  // Called for every frame in order; about 10 ms for 640x480 on one core.
  Observation step(const GrayFrame& frame);
  // The camera gave nothing up to `time`: nobody is seen, and holds run out.
  Observation step_blind(double time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
