// SPDX-License-Identifier: Apache-2.0
#include "world/placed_volume.h"

#include <glm/gtc/matrix_transform.hpp>

namespace wellspring::world {

VolumeBox box_of(const ShownVolume& volume) {
  const glm::dvec3 size(volume.levels.front().size);
  VolumeBox box;
  for (int corner = 0; corner < 8; corner++) {
    const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const vec3 place(volume.to_metres * glm::dvec4(side * size - 0.5, 1));
    box.low = glm::min(box.low, place), box.high = glm::max(box.high, place);
  }
  return box;
}

ToVolume::ToVolume(const PlacedVolume& placed)
    : middle(box_of(*placed.volume).middle()), position(placed.position), scale(placed.scale) {
  // The front of a volume is its +Z, and a yaw of 0 faces -Z.
  const float angle = placed.yaw + pi + placed.look.turn;
  turn = mat3(glm::rotate(mat4(1), -angle, vec3(0, 1, 0)));
}

Bounds bounds_of(const PlacedVolume& placed) {
  const VolumeBox box = box_of(*placed.volume);
  const vec3 half = 0.5f * placed.scale * (box.high - box.low);
  const float wide = std::hypot(half.x, half.z);
  Bounds bounds;
  bounds.low = placed.position - vec3(wide, half.y, wide);
  bounds.high = placed.position + vec3(wide, half.y, wide);
  return bounds;
}

}  // namespace wellspring::world
