// SPDX-License-Identifier: Apache-2.0
// The synthetic camera's world: a room with a wall and a picture frame, and a visitor who walks in,
// stands, looks about and leaves. The head is ray-cast (figure_head.h, one lamp), so its position
// and rotation are known exactly and what finds people finds it.
#pragma once
#include "base/vec.h"
#include "kiosk/frame/gray_frame.h"
#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

// Where the visitor is at a time; position and rotation as in wire/messages.h (Person).
struct FigurePose {
  bool visible = false;
  vec3 position{0, 0, 0.8f};
  vec3 rotation{0};
};

// The script, one round of `figure_round` seconds and then again: empty room, the visitor comes in
// from the screen's right, stands and looks around from `figure_stands` on, and is gone at
// `figure_gone`.
inline constexpr double figure_enters = 2.0, figure_stands = 3.5, figure_leaves = 14.0,
                        figure_gone = 15.5, figure_round = 22.0;
FigurePose figure_at(double time);

struct FigureRoom {
  int width = 640, height = 480;
  float light = 1;     // brightness of the lamp
  float noise = 2.5f;  // sensor noise, standard deviation in grey levels
  uint64_t seed = 1;   // of the noise; the same seed and time give the same picture
};

// The picture that a camera mounted as `mount` says would take. Deterministic.
GrayFrame draw_figure(const FigureRoom& room, const Mount& mount, const FigurePose& pose,
                      double time);

}  // namespace wellspring::kiosk
