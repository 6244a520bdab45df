// SPDX-License-Identifier: Apache-2.0
// What the hands of those who are followed say: a hand and a spotter for each person
// (kiosk/gesture).
#pragma once
#include <memory>
#include <string>

#include "kiosk/gesture/gesture_model.h"
#include "kiosk/frame/gray_frame.h"

namespace wellspring::kiosk {

class PersonGestures {
 public:
  // `models` is borrowed and must outlive this; null: nobody's hands are followed. `mirrored`: the
  // camera delivers a mirror image.
  PersonGestures(const GestureModels* models, bool mirrored);
  ~PersonGestures();
  // Called once a frame for each person whose face is followed. Returns the gesture that was
  // recognised within the last half second, or nothing; about 2 ms.
  std::string step(const GrayFrame& frame, uint32_t id, const Box& face);
  void forget(uint32_t id);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
