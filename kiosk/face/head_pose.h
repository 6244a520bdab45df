// SPDX-License-Identifier: Apache-2.0
// Finds where a head is and how it is turned, from 68 landmarks: a model of an adult's face is
// brought to its points in the picture (perspective n points). SQPnP (Terzakis, Lourakis, ECCV
// 2020) finds a first pose; Gauss-Newton steps with Huber's weights (Huber 1964) refine it over all
// points that move little with expression, so that a few wrong landmarks do not turn the head.
#pragma once
#include <optional>

#include "base/vec.h"
#include "kiosk/frame/head.h"
#include "kiosk/network/face_marks.h"

namespace wellspring::kiosk {

// Returns point k of the face, metres, in axes of a face that looks into the lens: x to image
// right, y down, z away from the lens; 0 is between the pupils. Measures of adults, means of women
// and men, are named in head_pose.cpp.
vec3 face_point(size_t k);

struct HeadPose {
  mat3 rotation{1};  // camera axes; identity: parallel to the picture, upright
  vec3 position{0};  // place between the pupils, camera axes, metres
  float error = 0;   // root mean square of the errors left, in distances between the pupils
};

// Solves for a pose; `focal` in pixels (focal_length). Returns nothing for landmarks that are not
// finite, lie on a point or line, or fit no face in front of the camera. For exact landmarks it is
// exact to 0.01 degrees and 0.1 %.
std::optional<HeadPose> solve_head_pose(const FaceMarks& marks, float focal, int width, int height);

// Returns how far landmarks with this error can be believed: 1 for a good fit, 0 from a bad one on.
float trust_of_error(float error);

}  // namespace wellspring::kiosk
