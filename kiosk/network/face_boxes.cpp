// SPDX-License-Identifier: Apache-2.0
#include "kiosk/network/face_boxes.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

// Widths and heights of the five usual boxes in cells, part of what was trained.
constexpr float anchors[detector_anchors][2] = {{1.603231f, 2.094468f},
                                                {6.041143f, 7.080126f},
                                                {2.882459f, 3.518061f},
                                                {4.266906f, 5.178857f},
                                                {9.041765f, 10.66308f}};
constexpr float same_face = 0.4f;    // share of the union of two boxes that both cover
constexpr float largest_growth = 3;  // natural logarithm; beyond, a number has run away

// Windows of little contrast are stretched to what the detector was trained on: found by trying.
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
