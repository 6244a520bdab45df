// SPDX-License-Identifier: Apache-2.0
// Says how one piece is seen, and by which planes that cuts it.
#pragma once
#include <vector>

#include "base/vec.h"
#include "store/picture/sample_picture.h"
#include "world/placed_volume.h"

namespace wellspring::show {

// Holds what is shown of a piece; layers are numbers of ExhibitPiece::layers.
struct PieceChoice {
  int layer = 0, over = 0;
  Blend by = Blend::none;
  float share = 0.5f;
  // How a volume is seen: radians to the left; and, of scans, too, corners of the part of its box
  // that is kept, 0 to 1; planes before which nothing is kept, as [x, y, z, metres from its
  // middle], 0: none.
  float turn = 0;
  vec3 low{0}, high{1};
  vec4 plane{0}, glass_plane{0};
  int tilt = 0;  // a nebula's axis leans so, degrees; 0: as at first
  bool operator==(const PieceChoice&) const = default;
};

// Returns the planes that a choice cuts a piece by that fills a box, in its own frame, where a
// metre is `scale` metres of the scene.
std::vector<VolumeCut> cuts_of(const VolumeBox& box, float scale, const PieceChoice& choice);

}  // namespace wellspring::show
