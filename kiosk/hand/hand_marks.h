// SPDX-License-Identifier: Apache-2.0
// Reads 21 landmarks of a hand whose place is known, by the graph handlandmark-lite of
// @vladmandic/human: the hand landmark model of MediaPipe (Zhang et al., "MediaPipe Hands:
// On-device Real-time Hand Tracking", 2020).
#pragma once
#include <array>
#include <string>

#include "base/vec.h"
#include "kiosk/network/face_marks.h"
#include "kiosk/network/graph/graph_network.h"

namespace wellspring::kiosk {

// Names landmarks in the published order: the wrist, then each finger's four from its root to its
// tip, from the thumb to the little finger.
inline constexpr size_t hand_points = 21;
inline constexpr size_t wrist_point = 0, index_root_point = 5, middle_root_point = 9,
                        little_root_point = 17, thumb_tip_point = 4, index_tip_point = 8;

struct HandMarks {
  // Pixels of the picture; z in pixels, too, less towards the camera, 0 at the wrist.
  std::array<vec3, hand_points> points{};
  // Metres in axes of the camera (x to image right, y down, z away) from the hand's middle.
  std::array<vec3, hand_points> metres{};
  float presence = 0;  // whether there is a hand, 0..1
};

// Returns the square in which a hand is read: round the landmarks of the picture before (section
// 2.2 and the published graph), or where a hand is thought to be that points away from `elbow`.
// `tenth`: pixels that 0.1 m take at the hand's distance.
Cut hand_cut_of_marks(const HandMarks& marks);
Cut hand_cut_of_arm(vec2 elbow, vec2 wrist, float tenth);
// Returns the square of an upright hand whose middle is there.
Cut hand_cut_of_place(vec2 middle, float tenth);

class HandReader {
 public:
  // `folder` has handlandmark-lite (WELLSPRING_WEIGHTS/human). Throws LoadError as open_graph does.
  explicit HandReader(const std::string& folder);
  // Reads a hand in about 10 ms.
  HandMarks read(const GrayView& picture, const TintView& tint, const Cut& square);

 private:
  GraphNetwork network_;
};

}  // namespace wellspring::kiosk
