// SPDX-License-Identifier: Apache-2.0
#include "kiosk/hand/hand_marks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

namespace wellspring::kiosk {

namespace {

constexpr const char* graph_name = "handlandmark-lite.json";
// The published graph's square: of the palm and the fingers' lower joints, twice as large, moved
// towards the fingers by a tenth of its side.
constexpr size_t square_points[] = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
constexpr float square_scale = 2, square_shift = 0.1f;
// Side of a square and way from the wrist to its middle, tenths of a metre: of a few pairs, these
// found most hands of people who sign (24 of 37 wrists; all of them again from their landmarks).
constexpr float hand_tenths = 2.6f, beyond_wrist = 0.6f;

// Returns the rotation of a cut whose upper side lies in the direction `up` of the picture.
float angle_of(vec2 up) { return std::atan2(-up.x, -up.y); }

}  // namespace

Cut hand_cut_of_marks(const HandMarks& marks) {
  // The rotation is that of the line from the wrist to the middle of three fingers' joints.
  const vec2 wrist{marks.points[wrist_point]};
  const vec2 joints =
      ((vec2(marks.points[6]) + vec2(marks.points[14])) / 2.f + vec2(marks.points[10])) / 2.f;
  Cut cut{{}, 1, 1, angle_of(joints - wrist)};
  const vec2 across = cut_to_picture(cut, {1.5f, 0.5f}), down = cut_to_picture(cut, {0.5f, 1.5f});
  vec2 low(1e9f), high(-1e9f);
  for (size_t point : square_points) {
    const vec2 pixel{marks.points[point]};
    const vec2 upright{glm::dot(pixel, across), glm::dot(pixel, down)};
    low = glm::min(low, upright), high = glm::max(high, upright);
  }
  const vec2 size = high - low;
  vec2 middle = (low + high) / 2.f;
  middle.y -= square_shift * size.y;
  cut.middle = middle.x * across + middle.y * down;
  cut.width = cut.height = square_scale * std::max(size.x, size.y);
  return cut;
}

Cut hand_cut_of_arm(vec2 elbow, vec2 wrist, float tenth) {
  const vec2 along = wrist - elbow;
  const float length = glm::length(along);
  if (!(length > 1)) return hand_cut_of_place(wrist, tenth);
  const float side = hand_tenths * tenth;
  return {wrist + along / length * (beyond_wrist * tenth), side, side, angle_of(along)};
}

Cut hand_cut_of_place(vec2 middle, float tenth) {
  const float side = hand_tenths * tenth;
  return {middle, side, side, 0};
}

HandReader::HandReader(const std::string& folder)
    : network_(open_graph((std::filesystem::path(folder) / graph_name).string())) {}

HandMarks HandReader::read(const GrayView& picture, const TintView& tint, const Cut& square) {
  const GraphNetwork::Input& size = network_.input();
  NetworkInput input = cut_out(picture, tint, square, size.columns, size.rows);
  for (float& level : input.planes) level /= 255;
  const Tensors outputs = network_.run(input.planes);
  const std::vector<float>& values = outputs.at("Identity").values;
  const std::vector<float>& metres = outputs.at("Identity_3").values;
  const auto side = float(size.columns);
  const float c = std::cos(square.angle), s = std::sin(square.angle);
  HandMarks out;
  out.presence = outputs.at("Identity_1").values.at(0);
  for (size_t k = 0; k < hand_points; k++) {
    const vec2 share = vec2(values[3 * k], values[3 * k + 1]) / side;
    out.points[k] = vec3(cut_to_picture(square, share), values[3 * k + 2] / side * square.width);
    const vec3 m{metres[3 * k], metres[3 * k + 1], metres[3 * k + 2]};
    out.metres[k] = {c * m.x + s * m.y, -s * m.x + c * m.y, m.z};
  }
  return out;
}

}  // namespace wellspring::kiosk
