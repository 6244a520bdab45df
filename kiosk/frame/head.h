// SPDX-License-Identifier: Apache-2.0
// From pixels to the visitor's place in metres, and back. Three frames of reference:
//   image   u to the right, v down, pixels; the camera's picture is not mirrored
//   camera  x as u, y as v, z forward out of the lens, metres
//   screen  what an observation speaks in (wire/messages.h): origin in the screen's centre,
//           +x to the right as the visitor sees the screen, +y up, +z out of it to the visitor
// The camera looks at the visitor, so its right is the visitor's left: image right is screen left,
// and the visitor's own left hand appears at image right. For a level camera, screen x = -camera x,
// y = -camera y.
#pragma once
#include <optional>

#include "base/vec.h"
#include "kiosk/frame/gray_frame.h"

namespace wellspring::kiosk {

// How the camera is fixed to the screen, and its lens.
struct Mount {
  float fov = 60 * pi / 180;  // horizontal, radians
  vec3 offset{0};             // the lens, metres from the screen's centre
  float pitch = 0;            // radians, positive: tilted upwards (often negative)
  bool mirrored = false;      // the source delivers a mirror image
};

// Focal length in pixels of a picture `width` pixels wide.
float focal_length(const Mount& mount, int width);

// The side in metres of the square that the frontal cascades put around an adult's face: 2.85 times
// the distance between the pupils (median over cascades and hand-marked faces), 63 mm in adults.
inline constexpr float face_box_metres = 0.18f;
// The box's centre lies this far below the pupils, in box sides (same faces).
inline constexpr float eyes_in_box = 0.375f;

// The point between the eyes of the face in `box`, in the camera's frame. `box` must not be empty.
vec3 face_in_camera(const Box& box, float focal, int width, int height);
vec3 camera_to_screen(const Mount& mount, vec3 camera);
vec3 screen_to_camera(const Mount& mount, vec3 screen);

// A rotation of the head as a matrix in screen axes, and back: yaw positive turned to +x, pitch
// positive looking up, roll positive tilted towards the visitor's right shoulder (+x). Identity
// faces the screen squarely.
mat3 rotation_matrix(vec3 yaw_pitch_roll);
vec3 yaw_pitch_roll(const mat3& rotation);

// `seen` is the rotation as the lens sees it: identity where the face looks straight into the lens,
// in axes of a visitor who does. The result is in screen axes: the bearing of the visitor and the
// camera's pitch are taken out as a product of rotations (subtracting angles would leak yaw into
// pitch).
vec3 rotation_on_screen(const Mount& mount, const mat3& seen, vec3 camera);
// The same of a rotation in camera axes, which is the identity where the face is parallel to the
// picture and upright, wherever it stands.
vec3 rotation_on_screen(const Mount& mount, const mat3& in_camera);
mat3 rotation_as_seen(const Mount& mount, vec3 yaw_pitch_roll, vec3 camera);

// The rotation, in screen axes, of a head at `position` (on the screen's visitor side) that faces
// the screen's centre.
vec3 rotation_to_center(vec3 position);

}  // namespace wellspring::kiosk
