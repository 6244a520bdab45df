// SPDX-License-Identifier: Apache-2.0
// What is wrong with a camera, told from its pictures alone, so that a technician need not guess.
#pragma once
#include <deque>
#include <vector>

#include "kiosk/frame/gray_frame.h"
#include "wire/messages.h"

namespace wellspring::kiosk {

class CameraWatch {
 public:
  static constexpr double told_after = 3;  // seconds that a fault must last
  static constexpr double least_rate = 8;  // pictures a second
  // The next frame; its time may run backwards where a file begins again.
  CameraState step(const GrayFrame& frame);
  // No picture for long.
  CameraState step_blind();

 private:
  std::vector<uint8_t> before_, now_;  // a pixel in 16
  double dark_since_ = 0, same_since_ = 0, begun_ = 0;
  std::deque<double> times_;  // of the last frames
};

}  // namespace wellspring::kiosk
