// SPDX-License-Identifier: Apache-2.0
#include "kiosk/camera_watch.h"

#include <algorithm>

namespace wellspring::kiosk {
namespace {

constexpr int every = 4;         // pixel of both ways is looked at
constexpr int darkest = 16;      // levels: black is what hardly any pixel exceeds
constexpr double rate_over = 5;  // seconds

}  // namespace

CameraState CameraWatch::step(const GrayFrame& frame) {
  now_.clear();
  for (int y = 0; y < frame.height; y += every)
    for (int x = 0; x < frame.width; x += every)
      now_.push_back(frame.pixels[size_t(y) * size_t(frame.width) + size_t(x)]);
  if (times_.empty() || frame.time < times_.back()) {
    times_.clear();
    begun_ = dark_since_ = same_since_ = frame.time;
    before_.clear();
  }
  const auto bright =
      std::count_if(now_.begin(), now_.end(), [](uint8_t level) { return level > darkest; });
  if (bright * 200 > ptrdiff_t(now_.size())) dark_since_ = frame.time;
  if (now_ != before_) same_since_ = frame.time;
  std::swap(now_, before_);
  times_.push_back(frame.time);
  while (times_.front() < frame.time - rate_over) times_.pop_front();
  if (frame.time - dark_since_ >= told_after) return CameraState::dark;
  if (frame.time - same_since_ >= told_after) return CameraState::frozen;
  const bool known = frame.time - begun_ >= rate_over;
  if (known && double(times_.size()) < least_rate * rate_over) return CameraState::slow;
  return CameraState::good;
}

CameraState CameraWatch::step_blind() {
  times_.clear();
  return CameraState::missing;
}

}  // namespace wellspring::kiosk
