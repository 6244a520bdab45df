// SPDX-License-Identifier: Apache-2.0
// One picture of the camera: luminance, row by row, top row first, and a small one in colour. It
// lives in this process for the time of one observation; nothing writes it to a file or a socket.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace wellspring::kiosk {

struct GrayFrame {
  double time = 0;  // seconds: a file's own time, or the monotonic clock of a live camera
  int width = 0, height = 0;
  std::vector<uint8_t> pixels{};
  // The same picture at no more than 320 pixels across, for hands: blue, green, red. Empty where
  // the camera has no colour.
  int color_width = 0, color_height = 0;
  std::vector<uint8_t> bgr{};
};

// A rectangle in pixels of the frame it belongs to; may be fractional. Empty when it has no width.
struct Box {
  float x = 0, y = 0, width = 0, height = 0;
  float center_x() const { return x + width / 2; }
  float center_y() const { return y + height / 2; }
};

// Area of the intersection over area of the union, 0 to 1.
inline float overlap(const Box& a, const Box& b) {
  float w = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  float h = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  if (!(w > 0 && h > 0)) return 0;
  return w * h / (a.width * a.height + b.width * b.height - w * h);
}

}  // namespace wellspring::kiosk
