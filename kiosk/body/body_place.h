// SPDX-License-Identifier: Apache-2.0
// Tells from the points of a body where it is, how tall, and whether it sits. Segments are shares
// of the body's height (Drillis, Contini 1966, in Winter, "Biomechanics and Motor Control of Human
// Movement", 2009, figure 4.1). A segment seen at a slant is shorter, never longer, so of all that
// are seen the one that gives the least distance is believed.
#pragma once
#include <optional>

#include "kiosk/body/body_marks.h"
#include "kiosk/frame/head.h"

namespace wellspring::kiosk {

// Heights of joints and lengths between them over the body's height.
inline constexpr float shoulder_share = 0.818f, hip_share = 0.53f, knee_share = 0.285f,
                       ankle_share = 0.039f, nose_share = 0.915f;
// Metres between the shoulder joints and from head to sole of the adult that is taken for granted
// while nothing tells a body's size.
inline constexpr float adult_shoulders = 0.36f, adult_height = 1.68f;

struct BodyView {
  float focal = 1;            // pixels
  int width = 0, height = 0;  // pixels
};

// Holds what is known of a body's distance besides its points, metres along the camera's axis.
struct KnownDepth {
  std::optional<float> face;   // depth of a face that belongs to it
  std::optional<float> floor;  // the floor's height in the frame of the screen
};

struct BodyMeasure {
  vec3 shoulders{0};           // middle, in the camera's frame, metres
  bool sized = false;          // the distance is known otherwise than by an adult's size
  float height = 0;            // as it would stand, metres; 0: not known
  std::optional<bool> seated;  // absent: hips or knees are not seen
  bool raised_hand = false;
  std::optional<float> ankles;  // their height in the frame of the screen, metres; if they are seen
};

// Returns nothing unless a shoulder and another point are seen.
std::optional<BodyMeasure> measure_body(const BodyMarks& marks, const BodyView& view,
                                        const Mount& mount, const KnownDepth& known = {});

// Returns whether the head of the body, or what is above its shoulders, is in the box of a face.
bool has_face(const BodyMarks& marks, const Box& face);

}  // namespace wellspring::kiosk
