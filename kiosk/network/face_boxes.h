// SPDX-License-Identifier: Apache-2.0
// Faces in a part of a picture, by the face detector of network.h: boxes from its cells (Redmon,
// Farhadi 2017, section 2), and of those that overlap the surest (non-maximum suppression).
#pragma once
#include <string>
#include <vector>

#include "kiosk/network/gray_view.h"

namespace wellspring::kiosk {

struct FaceBox {
  vec2 middle{0};               // pixels of the picture
  float width = 0, height = 0;  // about a fourth larger than what the 68 landmarks span
  float score = 0;              // 0..1
};

// Faces narrower than this in the network's picture are missed (brow to brow; measured).
inline constexpr float least_face = 40;

class FaceBoxes {
 public:
  explicit FaceBoxes(const std::string& folder);  // throws LoadError as load_face_detector does
  // Surest first; none below `least_score`. The cut is upright and seen at columns x rows pixels,
  // multiples of 32: 2.5 ms for 128x128, 12 ms for 320x256.
  std::vector<FaceBox> find(const GrayView& picture, const Cut& cut, int columns, int rows,
                            float least_score);

 private:
  Network network_;
};

}  // namespace wellspring::kiosk
