// SPDX-License-Identifier: Apache-2.0
// One frame in, one observation out: motion, faces, heads, hands, presence, in that order. What
// leaves is numbers.
#pragma once
#include <memory>

#include "kiosk/face/expression.h"
#include "kiosk/face/face.h"
#include "kiosk/gesture/gesture_model.h"
#include "kiosk/frame/head.h"
#include "kiosk/frame/one_euro.h"
#include "kiosk/motion.h"
#include "kiosk/people.h"
#include "kiosk/presence.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

// Of a head's rotation, radians; docs/benchmarks/kiosk.eye.md compares it.
inline constexpr OneEuroSettings rotation_filter{0.6f, 6.f, 1.f};

struct ObserverSettings {
  Mount mount;
  FaceSettings face;
  MotionSettings motion;
  PeopleSettings people;
  PresenceSettings presence;
  bool expression = false;  // estimate Person::expression; needs the networks' weights
  ExpressionSettings expressions;
  const GestureModels* gestures = nullptr;  // borrowed; null: hands are not followed
};

class Observer {
 public:
  // Throws LoadError when a cascade is missing.
  explicit Observer(const ObserverSettings& settings = {});
  ~Observer();
  // Called for every frame in order; about 10 ms for 640x480 on one core.
  Observation step(const GrayFrame& frame);
  // What is not needed is not computed from the next frame on; at first all of it is.
  void need(const EyeNeeds& needs);
  // The camera gave nothing up to `time`: nobody is seen, and holds run out.
  Observation step_blind(double time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
