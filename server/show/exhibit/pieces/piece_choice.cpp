// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/pieces/piece_choice.h"

namespace wellspring::show {

std::vector<VolumeCut> cuts_of(const VolumeBox& box, float scale, const PieceChoice& choice) {
  std::vector<VolumeCut> cuts;
  for (int axis = 0; axis < 3; axis++) {
    const float size = box.high[axis] - box.low[axis];
    vec3 normal(0);
    normal[axis] = 1;
    if (choice.low[axis] > 0) cuts.push_back({normal, box.low[axis] + choice.low[axis] * size});
    if (choice.high[axis] < 1)
      cuts.push_back({-normal, -(box.low[axis] + choice.high[axis] * size)});
  }
  for (const vec4& plane : {choice.plane, choice.glass_plane})
    if (const vec3 normal(plane); normal != vec3(0))
      cuts.push_back({normal, dot(normal, box.middle()) + plane.w / scale});
  return cuts;
}

}  // namespace wellspring::show
