// SPDX-License-Identifier: Apache-2.0
// Holds a recorded movement, wherever it comes from (BVH, HAnimMotion, interpolators of X3D,
// animations of glTF and VRM): key frames of a skeleton that the motion brings along, so that it
// can be shown on any other. It is plain data, immutable once loaded.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"

namespace wellspring::avatar {

// This is a joint of the motion's own skeleton at rest: +Y up, facing +Z, standing on y = 0.
struct MotionJoint {
  std::string name;  // H-Anim's name if it has one
  int parent = -1;
  vec3 center{0};
};

enum class TrackKind : uint8_t { rotation, translation, scale, displacer };
enum class TrackCurve : uint8_t { step, linear, cubic };

// Holds key frames of one joint or displacer. Turns are relative to the parent and to rest, about
// axes of the humanoid space at rest, as in a Pose; translations are added to the place at rest;
// scales are factors along the axes of `frame`.
struct MotionTrack {
  TrackKind kind = TrackKind::rotation;
  TrackCurve curve = TrackCurve::linear;
  int target = 0;            // index into Motion::joints or Motion::displacers
  std::vector<float> times;  // seconds, not decreasing, at least one
  std::vector<float>
      values;  // a key: x y z w, x y z or one weight; cubic: in-tangent, value, out-tangent
  quat frame{1, 0, 0, 0};
};

inline constexpr size_t most_motions = 512;  // a figure keeps no more

struct Motion {
  std::string name;
  float duration = 0;  // seconds
  bool loop = false;   // the file's wish
  std::vector<MotionJoint> joints;
  std::vector<std::string> displacers;
  std::vector<MotionTrack> tracks;
};

// Holds the motion's skeleton at one moment; joints and displacers without a track are at rest.
struct MotionPose {
  std::vector<quat> rotations;
  std::vector<vec3> translations;
  std::vector<mat3> stretches;  // empty: nothing is scaled
  std::vector<float> displacers;
};

// Returns `time` within the motion: around again if `loop`, else held at both ends. 0 for NaN.
double motion_time(const Motion& motion, double time, bool loop);
void eval_motion(const Motion& motion, double time, bool loop, MotionPose& pose);

}  // namespace wellspring::avatar
