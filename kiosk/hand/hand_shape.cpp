// SPDX-License-Identifier: Apache-2.0
#include "kiosk/hand/hand_shape.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

// Cosines of the angles by which a finger may be bent at its two joints and still is stretched.
constexpr float straight_middle = 0.6f, straight_end = 0.5f;
constexpr float straight_thumb = 0.8f;  // cosine at the thumb's end joint
constexpr float thumb_aside = 0.62f;    // tip to the index's root, over the palm's length
constexpr float pinched = 0.33f;        // tips of thumb and index apart, over the palm's length
constexpr float palm_metres = 0.095f;   // an adult's, from the wrist to the middle finger's root
constexpr float least_upright = 0.7f;   // cosine to the picture's upward axis
constexpr float nearest = 0.05f, farthest = 6;  // metres

float cosine(vec3 a, vec3 b) {
  const float lengths = glm::length(a) * glm::length(b);
  return lengths > 1e-9f ? glm::dot(a, b) / lengths : -1;
}

}  // namespace

HandShape shape_of(const HandMarks& marks) {
  const auto& p = marks.metres;
  const float palm = std::max(1e-4f, glm::length(p[middle_root_point] - p[wrist_point]));
  HandShape out;
  for (size_t finger = 1; finger < 5; finger++) {
    const size_t root = 1 + 4 * finger;
    const vec3 first = p[root + 1] - p[root], second = p[root + 2] - p[root + 1],
               third = p[root + 3] - p[root + 2];
    const bool farther =
        glm::length(p[root + 3] - p[wrist_point]) > glm::length(p[root + 1] - p[wrist_point]);
    out.stretched[finger] =
        farther && cosine(first, second) > straight_middle && cosine(second, third) > straight_end;
  }
  out.stretched[0] = cosine(p[3] - p[2], p[4] - p[3]) > straight_thumb &&
                     glm::length(p[thumb_tip_point] - p[index_root_point]) > thumb_aside * palm;
  out.fingers = int(std::ranges::count(out.stretched, true));
  const bool pinch = glm::length(p[thumb_tip_point] - p[index_tip_point]) < pinched * palm;
  const int others = out.fingers - out.stretched[0];
  if (out.fingers == 5) out.pose = HandPose::open;
  else if (pinch && others >= 1 && !(others == 1 && out.stretched[1])) out.pose = HandPose::pinch;
  else if (out.fingers == 0) out.pose = HandPose::fist;
  else if (out.fingers == 1 && out.stretched[1]) out.pose = HandPose::point;

  const vec3 up = p[middle_root_point] - p[wrist_point];
  auto points_up = [](vec3 way) { return -way.y > least_upright * glm::length(way); };
  out.upright = points_up(up);
  for (size_t finger = 1; finger < 5; finger++)
    if (out.stretched[finger]) out.upright &= points_up(p[4 + 4 * finger] - p[1 + 4 * finger]);
  out.roll = std::atan2(up.x, -up.y);
  return out;
}

// Each landmark says u (Z + z) = f (X + x), and likewise v: two equations that are linear in the
// hand's place (X, Y, Z), of which the least squares' Z is a quotient of covariances.
std::optional<HandInSpace> place_hand(const HandMarks& marks, float focal, int width, int height) {
  const float palm = glm::length(marks.metres[middle_root_point] - marks.metres[wrist_point]);
  if (!(palm > 0.01f)) return {};
  // The network's metres are of a hand of its own; all hands are taken for an adult's.
  const float scale = palm_metres / palm;
  const vec2 middle = vec2(float(width), float(height)) / 2.f;
  std::array<vec2, hand_points> tangents, rest;
  vec2 mean_tangent{0}, mean_rest{0};
  for (size_t k = 0; k < hand_points; k++) {
    const vec3 off = marks.metres[k] * scale;
    tangents[k] = (vec2(marks.points[k]) - middle) / focal;
    rest[k] = tangents[k] * off.z - vec2(off);
    mean_tangent += tangents[k] / float(hand_points);
    mean_rest += rest[k] / float(hand_points);
  }
  float shared = 0, spread = 0;
  for (size_t k = 0; k < hand_points; k++) {
    const vec2 tangent = tangents[k] - mean_tangent;
    shared += glm::dot(tangent, rest[k] - mean_rest), spread += glm::dot(tangent, tangent);
  }
  const float depth = -shared / spread;
  if (!(depth > nearest && depth < farthest)) return {};
  auto place = [&](size_t point) {
    return vec3(tangents[point], 1) * (depth + marks.metres[point].z * scale);
  };
  HandInSpace out;
  out.palm = (place(wrist_point) + place(index_root_point) + place(little_root_point)) / 3.f;
  out.index_root = place(index_root_point);
  out.index_tip = place(index_tip_point);
  return out;
}

std::optional<vec2> point_on_screen(vec3 from, vec3 through) {
  const vec3 along = through - from;
  // Rays almost along the screen end anywhere.
  if (!(along.z < -0.2f * glm::length(along)) || !(through.z > 0)) return {};
  const vec3 end = from - along * (from.z / along.z);
  const vec2 place{end.x, end.y};
  if (!(glm::length(place) < pointing_reach)) return {};
  return place;
}

}  // namespace wellspring::kiosk
