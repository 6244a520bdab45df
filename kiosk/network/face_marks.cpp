// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/face_marks.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace wellspring::kiosk {

vec2 cut_to_picture(const Cut& cut, vec2 share) {
  const float c = std::cos(cut.angle), s = std::sin(cut.angle);
  const vec2 q = (share - vec2(0.5f)) * vec2(cut.width, cut.height);
  return cut.middle + vec2(c * q.x + s * q.y, -s * q.x + c * q.y);
}

// Returns the cut of a picture of bytes with any number of channels.
static cv::Mat cut_of(const cv::Mat& whole, const Cut& cut, int columns, int rows) {
  cv::Mat source = whole, out;
  vec2 origin{0};
  float scale = 1;  // pixels of `source` per pixel of the picture
  const float shrink = cut.width / float(columns);
  if (shrink > 1.2f) {
    // The part that the cut touches is first made smaller by means over areas.
    const float reach = 0.5f * std::hypot(cut.width, cut.height) + 2 * shrink;
    cv::Rect area(int(cut.middle.x - reach), int(cut.middle.y - reach), int(2 * reach) + 1,
                  int(2 * reach) + 1);
    area &= cv::Rect(0, 0, whole.cols, whole.rows);
    const int w = int(std::lround(float(area.width) / shrink));
    const int h = int(std::lround(float(area.height) / shrink));
    if (w >= 1 && h >= 1) {
      cv::resize(whole(area), source, {w, h}, 0, 0, cv::INTER_AREA);
      origin = {float(area.x), float(area.y)};
      scale = 1 / shrink;
    }
  }
  // Middles of pixels lie at halves.
  auto to_source = [&](float x, float y) {
    const vec2 p =
        cut_to_picture(cut, {(x + 0.5f) / float(columns), (y + 0.5f) / float(rows)}) - origin;
    return p * scale - vec2(0.5f);
  };
  const vec2 a = to_source(0, 0), u = to_source(1, 0) - a, v = to_source(0, 1) - a;
  const cv::Mat map = (cv::Mat_<double>(2, 3) << u.x, v.x, a.x, u.y, v.y, a.y);
  cv::warpAffine(source, out, map, {columns, rows}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                 cv::BORDER_REPLICATE);
  return out;
}

NetworkInput cut_out(const GrayView& picture, const Cut& cut, int columns, int rows) {
  return cut_out(picture, {}, cut, columns, rows);
}

NetworkInput cut_out(const GrayView& picture, const TintView& tint, const Cut& cut, int columns,
                     int rows) {
  const cv::Mat whole(picture.height, picture.width, CV_8U, const_cast<uint8_t*>(picture.pixels));
  const cv::Mat out = cut_of(whole, cut, columns, rows);
  NetworkInput input{columns, rows, std::vector<float>(3 * out.total())};
  for (size_t c = 0; c < 3; c++)
    std::copy(out.ptr(), out.ptr() + out.total(),
              input.planes.begin() + std::ptrdiff_t(c * out.total()));
  if (!tint.bgr || tint.width < 1) return input;
  const float smaller = float(tint.width) / float(picture.width);
  const Cut same{cut.middle * smaller, cut.width * smaller, cut.height * smaller, cut.angle};
  const cv::Mat colors =
      cut_of(cv::Mat(tint.height, tint.width, CV_8UC3, const_cast<uint8_t*>(tint.bgr)), same,
             columns, rows);
  const uint8_t* pixel = colors.ptr();
  for (size_t i = 0; i < out.total(); i++, pixel += 3) {
    const float level = 0.114f * pixel[0] + 0.587f * pixel[1] + 0.299f * pixel[2];
    for (size_t c = 0; c < 3; c++) {
      float& value = input.planes[c * out.total() + i];
      value = std::clamp(value + pixel[2 - c] - level, 0.f, 255.f);
    }
  }
  return input;
}

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

namespace {

// These are widths and heights of the five usual boxes in cells, part of the training.
constexpr float anchors[detector_anchors][2] = {{1.603231f, 2.094468f},
                                                {6.041143f, 7.080126f},
                                                {2.882459f, 3.518061f},
                                                {4.266906f, 5.178857f},
                                                {9.041765f, 10.66308f}};
constexpr float same_face = 0.4f;    // share of the union of two boxes that both cover
constexpr float largest_growth = 3;  // natural logarithm; beyond, a number has run away

// Windows of little contrast are stretched to these levels of the detector's training, which were
// found by trying.
constexpr float usual_mean = 120, usual_deviation = 70, most_gain = 2.5f;

void stretch(NetworkInput& input) {
  double sum = 0, squares = 0;
  for (float level : input.planes) sum += level, squares += double(level) * level;
  const double count = double(input.planes.size()), mean = sum / count;
  const double deviation = std::sqrt(std::max(squares / count - mean * mean, 1.0));
  const float gain = std::min(usual_deviation / float(deviation), most_gain);
  if (!(gain > 1)) return;
  for (float& level : input.planes)
    level = std::clamp((level - float(mean)) * gain + usual_mean, 0.f, 255.f);
}

float sigmoid(float x) { return 1 / (1 + std::exp(-x)); }

float common(const FaceBox& a, const FaceBox& b) {
  const float w = (a.width + b.width) / 2 - std::abs(a.middle.x - b.middle.x);
  const float h = (a.height + b.height) / 2 - std::abs(a.middle.y - b.middle.y);
  const float both = std::min({w, a.width, b.width}) * std::min({h, a.height, b.height});
  if (!(w > 0 && h > 0)) return 0;
  return both / (a.width * a.height + b.width * b.height - both);
}

}  // namespace

FaceBoxes::FaceBoxes(const std::string& folder) : network_(load_face_detector(folder)) {}

std::vector<FaceBox> FaceBoxes::find(const GrayView& picture, const Cut& cut, int columns, int rows,
                                     float least_score) {
  NetworkInput input = cut_out(picture, cut, columns, rows);
  stretch(input);
  const std::vector<float> out = network_.run(input);
  const int across = columns / detector_cell, down = rows / detector_cell;
  const vec2 cells{float(across), float(down)};
  std::vector<FaceBox> all, kept;
  for (int a = 0; a < detector_anchors; a++)
    for (int y = 0; y < down; y++)
      for (int x = 0; x < across; x++) {
        auto value = [&](int k) { return out[size_t(((5 * a + k) * down + y) * across + x)]; };
        const float score = sigmoid(value(4));
        if (!(score >= least_score)) continue;
        FaceBox box;
        box.middle = cut_to_picture(
            cut, vec2(float(x) + sigmoid(value(0)), float(y) + sigmoid(value(1))) / cells);
        box.width =
            std::exp(std::min(value(2), largest_growth)) * anchors[a][0] / cells.x * cut.width;
        box.height =
            std::exp(std::min(value(3), largest_growth)) * anchors[a][1] / cells.y * cut.height;
        box.score = score;
        all.push_back(box);
      }
  std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.score > b.score; });
  for (const FaceBox& box : all)
    if (std::none_of(kept.begin(), kept.end(),
                     [&](const FaceBox& other) { return common(box, other) > same_face; }))
      kept.push_back(box);
  return kept;
}

}  // namespace wellspring::kiosk
