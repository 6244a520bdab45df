// SPDX-License-Identifier: Apache-2.0
// Maps pixels to the visitor's place in metres, and back. Three frames of reference:
//   image   u to the right, v down, pixels; the camera's picture is not mirrored
//   camera  x as u, y as v, z forward out of the lens, metres
//   screen  the frame of observations (wire/eye_messages.h): origin in the screen's centre,
//           +x to the right as the visitor sees the screen, +y up, +z out of it to the visitor
// The camera looks at the visitor, so its right is the visitor's left: image right is screen left,
// and the visitor's own left hand appears at image right. For a level camera, screen x = -camera x,
// y = -camera y.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/vec.h"

namespace wellspring::kiosk {

// Holds one picture of the camera: luminance, row by row, top row first, and a small one in colour.
// It lives in this process for the time of one observation; nothing writes it to a file or a
// socket.

struct GrayFrame {
  double time = 0;  // seconds: a file's own time, or the monotonic clock of a live camera
  int width = 0, height = 0;
  std::vector<uint8_t> pixels{};
  // The same picture at no more than 320 pixels across, for hands: blue, green, red. Empty if the
  // camera has no colour.
  int color_width = 0, color_height = 0;
  std::vector<uint8_t> bgr{};
};

// This is a rectangle in pixels of its frame; may be fractional. Empty when it has no width.
struct Box {
  float x = 0, y = 0, width = 0, height = 0;
  float center_x() const { return x + width / 2; }
  float center_y() const { return y + height / 2; }
};

// Returns the area of the intersection over the area of the union, 0 to 1.
inline float overlap(const Box& a, const Box& b) {
  float w = std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x);
  float h = std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y);
  if (!(w > 0 && h > 0)) return 0;
  return w * h / (a.width * a.height + b.width * b.height - w * h);
}

// Describes how the camera is fixed to the screen, and its lens.
struct Mount {
  float fov = 60 * pi / 180;  // horizontal, radians
  vec3 offset{0};             // place of the lens, metres from the screen's centre
  float pitch = 0;            // radians, positive: tilted upwards (often negative)
  // radians by which the camera is turned clockwise about the way it looks, +-pi. Its pictures are
  // turned upright by quarter turns (make_camera); what is left is taken out of places.
  float roll = 0;
  bool mirrored = false;  // the source delivers a mirror image
};

// Returns the quarter turns, clockwise, that bring the camera's pictures upright: -1, 0, 1 or 2.
int quarter_turns(const Mount& mount);
// Returns the focal length in pixels of an upright picture; a camera that is mounted sideways has
// its field of view from top to bottom.
float focal_length(const Mount& mount, int width, int height);

// This is the side in metres of the square that the frontal cascades put around an adult's face:
// 2.85 times the distance between the pupils (median over cascades and hand-marked faces), 63 mm in
// adults.
inline constexpr float face_box_metres = 0.18f;
// The box's centre lies this far below the pupils, in box sides (same faces).
inline constexpr float eyes_in_box = 0.375f;

// Returns the point between the eyes of the face in `box`, in the camera's frame. `box` must not be
// empty.
vec3 face_in_camera(const Box& box, float focal, int width, int height);
vec3 camera_to_screen(const Mount& mount, vec3 camera);
vec3 screen_to_camera(const Mount& mount, vec3 screen);

// Convert a rotation of the head to a matrix in screen axes, and back: yaw positive turned to +x,
// pitch positive looking up, roll positive tilted towards the visitor's right shoulder (+x).
// Identity faces the screen squarely.
mat3 rotation_matrix(vec3 yaw_pitch_roll);
vec3 yaw_pitch_roll(const mat3& rotation);

// Returns a rotation in screen axes. `seen` is the rotation as the lens sees it: identity if the
// face looks straight into the lens, in axes of a visitor who does. The bearing of the visitor and
// the camera's pitch are taken out as a product of rotations (subtracting angles would leak yaw
// into pitch).
vec3 rotation_on_screen(const Mount& mount, const mat3& seen, vec3 camera);
// Does the same for a rotation in camera axes, which is the identity if the face is parallel to the
// picture and upright, wherever it is.
vec3 rotation_on_screen(const Mount& mount, const mat3& in_camera);
mat3 rotation_as_seen(const Mount& mount, vec3 yaw_pitch_roll, vec3 camera);

// Returns the rotation, in screen axes, of a head at `position` (on the screen's visitor side) that
// faces the screen's centre.
vec3 rotation_to_center(vec3 position);

// Filters by the one-euro filter (Casiez, Roussel, Vogel, CHI 2012, section 3): a low pass whose
// cut-off rises with the speed of the signal, so a resting head rests and a quick one is not late.
// To tune it, lower `min_cutoff` until rest is still, then raise `beta` until motion does not lag.

struct OneEuroSettings {
  float min_cutoff = 1;    // Hz
  float beta = 0;          // Hz per (unit a second)
  float speed_cutoff = 1;  // Hz, for the speed's own filter
};

struct OneEuro {
  bool started = false;
  double time = 0;
  vec3 value{0}, speed{0};
};

inline float one_euro_alpha(float cutoff, float step) {
  float tau = 1 / (2 * pi * cutoff);
  return 1 / (1 + tau / step);
}

// Returns the filtered value of `raw` seen at `time` seconds. The first value passes as it is; a
// value that is not finite, or not later than the last one, changes nothing.
inline vec3 step_one_euro(OneEuro& filter, const OneEuroSettings& settings, double time, vec3 raw) {
  if (!is_finite(raw)) return filter.value;
  if (!filter.started) {
    filter = {true, time, raw, vec3(0)};
    return raw;
  }
  float step = float(time - filter.time);
  if (!(step > 0)) return filter.value;
  filter.time = time;
  vec3 speed = (raw - filter.value) / step;
  filter.speed += one_euro_alpha(settings.speed_cutoff, step) * (speed - filter.speed);
  float cutoff = settings.min_cutoff + settings.beta * glm::length(filter.speed);
  filter.value += one_euro_alpha(cutoff, step) * (raw - filter.value);
  return filter.value;
}

}  // namespace wellspring::kiosk
