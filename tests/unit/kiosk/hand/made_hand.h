// SPDX-License-Identifier: Apache-2.0
// Makes landmarks of a hand as a camera would see them: a palm of 95 mm and fingers of three bones
// that are stretched or bent.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "kiosk/hand/hand_shape.h"

namespace wellspring::test {

struct MadeHand {
  std::array<bool, 5> stretched = {true, true, true, true, true};  // from the thumb
  bool pinched = false;       // thumb and index touch, the others are stretched
  vec3 palm{0, -0.1f, 0.6f};  // wrist, in the frame of the screen, metres
  float roll = 0;             // clockwise in the picture, radians
  float pitch = 0;            // fingers towards the camera, radians
  float presence = 0.95f;
};

inline constexpr int hand_picture_width = 640, hand_picture_height = 480;

// Returns the landmarks in metres from the wrist in axes of the camera: fingers point up.
inline std::array<vec3, hand_points> metres_of(const MadeHand& hand) {
  std::array<vec3, hand_points> p{};
  // Roots of the index to the little finger, and their bones.
  const vec3 roots[] = {
      {-0.025f, -0.09f, 0}, {0, -0.095f, 0}, {0.02f, -0.09f, 0}, {0.04f, -0.08f, 0}};
  const float bones[][3] = {{0.04f, 0.025f, 0.02f},
                            {0.045f, 0.03f, 0.02f},
                            {0.04f, 0.028f, 0.02f},
                            {0.03f, 0.02f, 0.018f}};
  for (size_t finger = 0; finger < 4; finger++) {
    vec3 at = roots[finger];
    p[5 + 4 * finger] = at;
    float bend = 0;
    const bool straight = hand.stretched[finger + 1];
    for (size_t bone = 0; bone < 3; bone++) {
      // A bent finger folds in front of the palm.
      if (!straight) bend += bone == 0 ? 0.9f : 1.5f;
      at += bones[finger][bone] * vec3(0, -std::cos(bend), -std::sin(bend));
      p[6 + 4 * finger + bone] = at;
    }
  }
  const vec3 aside = glm::normalize(vec3(-0.8f, -0.6f, 0));
  p[1] = {-0.02f, -0.02f, 0}, p[2] = p[1] + 0.04f * aside;
  if (hand.stretched[0]) p[3] = p[2] + 0.035f * aside, p[4] = p[3] + 0.03f * aside;
  else p[3] = p[2] + vec3(0.01f, -0.03f, -0.01f), p[4] = p[3] + vec3(0.025f, -0.005f, -0.01f);
  if (hand.pinched) {
    p[8] = p[4] + vec3(0.005f, -0.005f, 0);
    p[7] = p[8] + vec3(0.01f, -0.015f, 0), p[6] = (p[5] + p[7]) / 2.f + vec3(0, -0.02f, 0);
  }
  const float cr = std::cos(hand.roll), sr = std::sin(hand.roll);
  const float cp = std::cos(hand.pitch), sp = std::sin(hand.pitch);
  for (vec3& v : p) {
    v = {v.x, cp * v.y - sp * v.z, sp * v.y + cp * v.z};
    v = {cr * v.x - sr * v.y, sr * v.x + cr * v.y, v.z};
  }
  return p;
}

// `tremble`: deviation of each landmark, metres in the picture's plane and thrice as much away.
inline HandMarks marks_of(const MadeHand& hand, const Mount& mount = {}, float tremble = 0,
                          uint64_t seed = 1) {
  const float focal = focal_length(mount, hand_picture_width, hand_picture_width);
  const vec3 wrist = screen_to_camera(mount, hand.palm);
  HandMarks out;
  out.presence = hand.presence;
  out.metres = metres_of(hand);
  uint64_t state = seed;
  auto noise = [&] {
    float sum = 0;
    for (int i = 0; i < 4; i++) {
      state = state * 6364136223846793005ull + 1442695040888963407ull;
      sum += float(state >> 40) / float(1 << 24) - 0.5f;
    }
    return sum * 1.73f * tremble;
  };
  for (size_t k = 0; k < hand_points; k++) {
    out.metres[k] += vec3(noise(), noise(), 3 * noise());
    const vec3 at = wrist + out.metres[k];
    out.points[k] =
        vec3(vec2(at) / at.z * focal + vec2(hand_picture_width, hand_picture_height) / 2.f,
             out.metres[k].z / wrist.z * focal);
  }
  return out;
}

}  // namespace wellspring::test
