// SPDX-License-Identifier: Apache-2.0
// Makes the points of a body as a camera would see them: an upright figure of the shares of
// body_place.h.
#pragma once
#include <array>
#include <optional>

#include "kiosk/body/body_place.h"

namespace wellspring::test {

struct MadeBody {
  vec3 feet{0, -1.2f, 4};  // between the feet, in the frame of the screen, metres
  float height = adult_height;
  float turned = 0;       // radians about its axis
  bool seated = false;    // thighs towards the screen
  bool raised = false;    // the right hand
  float cut_below = 1e9;  // points below this row of the picture are not seen
};

inline constexpr int made_width = 640, made_height = 480;

// The points that a camera with that mount sees.
inline BodyMarks marks_of(const MadeBody& body, const Mount& mount = {}) {
  const float h = body.height;
  // The torso of somebody who sits is as much lower as the thighs are long.
  const float drop = body.seated ? (hip_share - knee_share) * h : 0;
  const float aside = adult_shoulders / adult_height * h / 2, hip = 0.095f * h;
  auto at = [&](float right, float up, float front = 0) { return vec3(right, up, front); };
  const float shoulder = shoulder_share * h - drop, hips = hip_share * h - drop;
  const float knee = knee_share * h, ankle = ankle_share * h;
  const float front = body.seated ? (hip_share - knee_share) * h : 0;
  const float nose = nose_share * h - drop;
  const float wrist = body.raised ? shoulder + 0.25f * h : hips;
  const std::array<vec3, body_points> points = {
      at(0, nose, 0.05f),     at(-0.03f, nose + 0.03f), at(0.03f, nose + 0.03f),
      at(-0.07f, nose),       at(0.07f, nose),          at(-aside, shoulder),
      at(aside, shoulder),    at(-aside, hips + 0.1f),  at(aside, hips + 0.1f),
      at(-aside, hips),       at(aside, wrist),         at(-hip, hips),
      at(hip, hips),          at(-hip, knee, front),    at(hip, knee, front),
      at(-hip, ankle, front), at(hip, ankle, front)};
  const float c = std::cos(body.turned), s = std::sin(body.turned);
  const float focal = focal_length(mount, made_width, made_height);
  BodyMarks out;
  out.score = 0.9f;
  for (size_t k = 0; k < body_points; k++) {
    const vec3 p = points[k];
    // The person faces the screen: their front is towards -z.
    const vec3 place = body.feet + vec3(c * p.x + s * p.z, p.y, s * p.x - c * p.z);
    const vec3 camera = screen_to_camera(mount, place);
    BodyMark& mark = out.points[k];
    mark.pixel = vec2(camera) / camera.z * focal + vec2(made_width, made_height) / 2.f;
    const bool seen = mark.pixel.x >= 0 && mark.pixel.x < made_width && mark.pixel.y >= 0 &&
                      mark.pixel.y < std::min(float(made_height), body.cut_below);
    mark.score = seen ? 0.8f : 0.05f;
  }
  return out;
}

// The box of the face of such a body, as a finder would put it.
inline Box face_of(const BodyMarks& marks, float depth, const Mount& mount = {}) {
  const float side = face_box_metres * focal_length(mount, made_width, made_height) / depth;
  const vec2 nose = marks.at(BodyPoint::nose).pixel;
  return {nose.x - side / 2, nose.y - side / 2, side, side};
}

}  // namespace wellspring::test
