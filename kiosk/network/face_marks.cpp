// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/face_marks.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float rim = 1.25f;  // side of the square over the larger side of what landmarks span

}  // namespace

Cut cut_of_marks(const FaceMarks& marks) {
  vec2 left{0}, right{0};
  for (size_t k = 36; k < 42; k++) left += marks[k] / 6.f, right += marks[k + 6] / 6.f;
  const float angle = std::atan2(left.y - right.y, right.x - left.x);
  const float c = std::cos(angle), s = std::sin(angle);
  vec2 low(1e9f), high(-1e9f);
  for (vec2 p : marks) {
    const vec2 upright{c * p.x - s * p.y, s * p.x + c * p.y};
    low = glm::min(low, upright), high = glm::max(high, upright);
  }
  const vec2 middle = (low + high) / 2.f;
  const float side = rim * std::max(high.x - low.x, high.y - low.y);
  return {{c * middle.x + s * middle.y, -s * middle.x + c * middle.y}, side, side, angle};
}

MarkReader::MarkReader(const std::string& folder) : network_(load_face_landmarks(folder)) {}

FaceMarks MarkReader::read(const GrayView& picture, const Cut& square) {
  const auto out = network_.run(cut_out(picture, square, marks_side, marks_side));
  FaceMarks marks;
  for (size_t k = 0; k < marks.size(); k++)
    marks[k] = cut_to_picture(square, {out[2 * k], out[2 * k + 1]});
  return marks;
}

ClassReader::ClassReader(const std::string& folder) : network_(load_face_expression(folder)) {}

FaceClasses ClassReader::read(const GrayView& picture, const Cut& square) {
  const auto out = network_.run(cut_out(picture, square, marks_side, marks_side));
  FaceClasses classes;
  std::copy_n(out.begin(), classes.size(), classes.begin());
  return classes;
}

}  // namespace wellspring::kiosk
