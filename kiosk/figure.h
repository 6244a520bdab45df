// SPDX-License-Identifier: Apache-2.0
// Draws the synthetic camera's world: a room with a wall and a picture frame, and a visitor who
// walks in, stands, looks about and leaves. The head is ray-cast (figure.h, one lamp), so its
// position and rotation are known exactly, and detectors find it.
#pragma once
#include <optional>

#include "base/vec.h"
#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

// Says where the visitor is at a time; position and rotation as in wire/eye_messages.h (Person).
struct FigurePose {
  bool visible = false;
  vec3 position{0, 0, 0.8f};
  vec3 rotation{0};
};

// The script is one round of `figure_round` seconds and then again: empty room, the visitor comes
// in from the screen's right, stands and looks around from `figure_stands` on, and is gone at
// `figure_gone`.
inline constexpr double figure_enters = 2.0, figure_stands = 3.5, figure_leaves = 14.0,
                        figure_gone = 15.5, figure_round = 22.0;
FigurePose figure_at(double time);

struct FigureRoom {
  int width = 640, height = 480;
  float light = 1;     // brightness of the lamp
  float noise = 2.5f;  // sensor noise, standard deviation in grey levels
  uint64_t seed = 1;   // seed of the noise; the same seed and time give the same picture
};

// Draws the picture that a camera mounted as `mount` says would take. Deterministic.
GrayFrame draw_figure(const FigureRoom& room, const Mount& mount, const FigurePose& pose,
                      double time);

// Finds where rays hit the head of the synthetic visitor: an adult's, made of distances (Hart 1996,
// sphere tracing) that are joined smoothly, with painted eyes, brows, lips and hair. Its measures
// are those of Farkas (Anthropometry of the Head and Face, 1994), so networks trained on people
// recognise it.
// Axes: x to the visitor's right, y up, z out of the face; origin between the pupils; metres.

struct HeadHit {
  float t = 0;     // position along the ray
  vec3 normal{0};  // outwards, of length 1
  float albedo = 0;
};

// Returns where a ray (direction of any length) meets the head first.
std::optional<HeadHit> hit_head(vec3 origin, vec3 direction);

}  // namespace wellspring::kiosk
