// SPDX-License-Identifier: Apache-2.0
#include "kiosk/station/glance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace wellspring::kiosk {
namespace {

constexpr int glance_across = 64;
constexpr int pixel_stride = 2;        // pixels between those that count
constexpr float cell_differs = 10;     // brightness, 0..255
constexpr int most_alike = 2;          // cells of a block of 3 by 3 that may be as they were
constexpr double motion_apart = 0.15;  // seconds between pictures whose difference is motion
constexpr int moving_blocks = 6;

// Returns the mean brightness of each cell.
std::vector<float> cell_means(const GrayFrame& frame, int across, int down) {
  std::vector<float> out;
  for (int row = 0; row < down; row++)
    for (int column = 0; column < across; column++) {
      int sum = 0, count = 0;
      for (int y = row * frame.height / down; y < (row + 1) * frame.height / down;
           y += pixel_stride)
        for (int x = column * frame.width / across; x < (column + 1) * frame.width / across;
             x += pixel_stride)
          sum += frame.pixels[size_t(y) * size_t(frame.width) + size_t(x)], count++;
      out.push_back(float(sum) / float(std::max(count, 1)));
    }
  return out;
}

}  // namespace

// Says whether so many blocks differ, but for a change of all the light.
bool Glance::differs(const std::vector<float>& from, int least_blocks) const {
  if (from.size() != now_.size()) return true;
  std::vector<float> off(now_.size());
  for (size_t i = 0; i < off.size(); i++) off[i] = now_[i] - from[i];
  std::vector<float> sorted = off;
  std::nth_element(sorted.begin(), sorted.begin() + long(sorted.size() / 2), sorted.end());
  const float light = sorted[sorted.size() / 2];
  int blocks = 0;
  for (int row = 0; row + 3 <= down_; row++)
    for (int column = 0; column + 3 <= across_; column++) {
      int alike = 0;
      for (int i = 0; i < 9 && alike <= most_alike; i++)
        alike +=
            std::abs(off[size_t((row + i / 3) * across_ + column + i % 3)] - light) < cell_differs;
      blocks += alike <= most_alike;
    }
  return blocks >= least_blocks;
}

void Glance::step(const GrayFrame& frame) {
  if (frame.width != width_ || frame.height != height_) {
    width_ = frame.width, height_ = frame.height;
    across_ = std::min(glance_across, width_), down_ = std::max(1, across_ * height_ / width_);
    before_.clear(), vain_.clear();
  }
  now_ = cell_means(frame, across_, down_);
  changed_ = differs(vain_, 1);
  if (frame.time >= before_at_ && frame.time - before_at_ < motion_apart) return;
  rests_ = !before_.empty() && !differs(before_, moving_blocks);
  before_ = now_, before_at_ = frame.time;
}

}  // namespace wellspring::kiosk
