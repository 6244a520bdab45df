// SPDX-License-Identifier: Apache-2.0
#include "kiosk/body/body_place.h"

#include <algorithm>
#include <cmath>

namespace wellspring::kiosk {

namespace {

constexpr float least_pixels = 4;      // a segment needs, to tell a distance
constexpr float seated_thigh = 0.5f;   // height of the thigh over the torso's; 0.85 standing
constexpr float over_shoulder = 0.2f;  // a raised wrist is above by so many widths of the shoulders
constexpr float nearest = 0.3f, farthest = 12;  // metres

// Returns the middle of the sides that are seen.
std::optional<vec2> middle_of(const BodyMarks& marks, BodyPoint left, BodyPoint right) {
  const BodyMark &a = marks.at(left), &b = marks.at(right);
  const bool has_a = a.score >= least_point_score, has_b = b.score >= least_point_score;
  if (has_a && has_b) return (a.pixel + b.pixel) / 2.f;
  if (has_a) return a.pixel;
  if (has_b) return b.pixel;
  return {};
}

struct Joints {
  std::optional<vec2> shoulders, hips, knees, ankles, nose;
  float width = 0;  // pixels between the shoulders; 0: one is not seen
};

Joints joints_of(const BodyMarks& marks) {
  using enum BodyPoint;
  Joints out;
  out.shoulders = middle_of(marks, left_shoulder, right_shoulder);
  out.hips = middle_of(marks, left_hip, right_hip);
  out.knees = middle_of(marks, left_knee, right_knee);
  out.ankles = middle_of(marks, left_ankle, right_ankle);
  out.nose = middle_of(marks, nose, nose);
  const BodyMark &left = marks.at(left_shoulder), &right = marks.at(right_shoulder);
  if (std::min(left.score, right.score) >= least_point_score)
    out.width = glm::length(left.pixel - right.pixel);
  return out;
}

// Returns the least distance of an adult whose segments are seen like these.
std::optional<float> depth_of_adult(const Joints& joints, float focal) {
  std::optional<float> least;
  auto offer = [&](float pixels, float metres) {
    if (pixels < least_pixels) return;
    const float depth = focal * metres / pixels;
    least = std::min(least.value_or(depth), depth);
  };
  offer(joints.width, adult_shoulders);
  if (joints.hips)
    offer(glm::length(*joints.hips - *joints.shoulders),
          (shoulder_share - hip_share) * adult_height);
  if (joints.nose && joints.ankles)
    offer(glm::length(*joints.ankles - *joints.nose), (nose_share - ankle_share) * adult_height);
  return least;
}

// Returns how far along the camera's axis a pixel meets the floor.
std::optional<float> depth_on_floor(vec2 pixel, const BodyView& view, const Mount& mount,
                                    float floor) {
  const vec3 ray{(pixel.x - float(view.width) / 2) / view.focal,
                 (pixel.y - float(view.height) / 2) / view.focal, 1};
  const float start = camera_to_screen(mount, vec3(0)).y;
  const float slope = camera_to_screen(mount, ray).y - start;
  if (slope > -0.02f) return {};  // the ray hardly falls
  return (floor - start) / slope;
}

// Returns the height of the body from the lowest joint that is seen, pixels.
float pixels_of_height(const Joints& joints, bool seated) {
  if (!seated && joints.nose) {
    if (joints.ankles) return (joints.ankles->y - joints.nose->y) / (nose_share - ankle_share);
    if (joints.knees) return (joints.knees->y - joints.nose->y) / (nose_share - knee_share);
  }
  if (joints.hips)
    return glm::length(*joints.hips - *joints.shoulders) / (shoulder_share - hip_share);
  return 0;
}

}  // namespace

std::optional<BodyMeasure> measure_body(const BodyMarks& marks, const BodyView& view,
                                        const Mount& mount, const KnownDepth& known) {
  const Joints joints = joints_of(marks);
  if (!joints.shoulders || !(view.focal > 0)) return {};
  BodyMeasure out;
  std::optional<float> depth = known.face;
  if (!depth && known.floor && joints.ankles)
    depth = depth_on_floor(*joints.ankles, view, mount, *known.floor);
  out.sized = depth.has_value();
  if (!depth) depth = depth_of_adult(joints, view.focal);
  if (!depth || !std::isfinite(*depth)) return {};
  const float z = std::clamp(*depth, nearest, farthest);
  auto place = [&](vec2 pixel) {
    return vec3((pixel.x - float(view.width) / 2) / view.focal,
                (pixel.y - float(view.height) / 2) / view.focal, 1) *
           z;
  };
  out.shoulders = place(*joints.shoulders);
  if (joints.hips && joints.knees) {
    const float torso = joints.hips->y - joints.shoulders->y;
    const float thigh = joints.knees->y - joints.hips->y;
    if (torso >= least_pixels) out.seated = thigh < seated_thigh * torso;
  }
  if (out.sized) {
    const float metres = pixels_of_height(joints, out.seated.value_or(false)) * z / view.focal;
    if (metres >= 0.5f && metres <= 2.3f) out.height = metres;
  }
  if (joints.ankles && !out.seated.value_or(true))
    out.ankles = camera_to_screen(mount, place(*joints.ankles)).y;
  const float above =
      joints.shoulders->y - over_shoulder * std::max(joints.width, view.focal * 0.2f / z);
  for (BodyPoint wrist : {BodyPoint::left_wrist, BodyPoint::right_wrist})
    out.raised_hand |=
        marks.at(wrist).score >= least_point_score && marks.at(wrist).pixel.y < above;
  return out;
}

bool has_face(const BodyMarks& marks, const Box& face) {
  auto inside = [&](vec2 p) {
    return p.x >= face.x && p.x <= face.x + face.width && p.y >= face.y &&
           p.y <= face.y + face.height;
  };
  for (BodyPoint point : {BodyPoint::nose, BodyPoint::left_eye, BodyPoint::right_eye}) {
    const BodyMark& mark = marks.at(point);
    if (mark.score >= least_point_score) return inside(mark.pixel);
  }
  return false;
}

}  // namespace wellspring::kiosk
