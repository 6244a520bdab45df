// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/character.h"

namespace wellspring::avatar {

const char* to_string(Detail detail) {
  switch (detail) {
    case Detail::none: return "none";
    case Detail::medium: return "medium";
    case Detail::full: break;
  }
  return "full";
}

Detail next_detail(Detail before, float distance, const DetailWalls& walls) {
  if (!(distance == distance)) return before;
  // Each wall stands nearer to a viewer who is outside of it.
  float near = walls.near + (before == Detail::full ? walls.hysteresis : -walls.hysteresis);
  float far = walls.far + (before == Detail::none ? -walls.hysteresis : walls.hysteresis);
  return distance < near ? Detail::full : distance < far ? Detail::medium : Detail::none;
}

}  // namespace wellspring::avatar
