// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/box_shadow.h"

namespace wellspring::scan {

void BoxShadow::add(const dvec3& normal, const dvec3& through) {
  planes_[size_t(count_++)] = {normal, -glm::dot(normal, through)};
}

BoxShadow::BoxShadow(const dvec3& eye, const DoubleBox& box) {
  // Along an axis the eye lies below the box, above it, or between its faces.
  int side[3];
  for (int axis = 0; axis < 3; axis++)
    side[axis] = eye[axis] < box.low[axis] ? -1 : eye[axis] > box.high[axis] ? 1 : 0;
  if (side[0] == 0 && side[1] == 0 && side[2] == 0) return;
  const dvec3 centre = (box.low + box.high) / 2.0;
  for (int axis = 0; axis < 3; axis++) {
    if (side[axis] == 0) continue;
    dvec3 normal(0);
    normal[axis] = -side[axis];
    add(normal, side[axis] < 0 ? box.low : box.high);
  }
  // An edge is between two faces of different axes; it is of the silhouette if one of them looks at
  // the eye and the other does not.
  for (int axis = 0; axis < 3; axis++) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int at_u : {-1, 1})
      for (const int at_v : {-1, 1}) {
        if ((side[u] == at_u) == (side[v] == at_v)) continue;
        dvec3 corner = box.low, along(0);
        if (at_u > 0) corner[u] = box.high[u];
        if (at_v > 0) corner[v] = box.high[v];
        along[axis] = 1;
        dvec3 normal = glm::cross(corner - eye, along);
        if (glm::dot(normal, centre - eye) < 0) normal = -normal;
        add(normal, eye);
      }
  }
}

bool BoxShadow::hides(const DoubleBox& other) const {
  const dvec3 centre = (other.low + other.high) / 2.0, half = (other.high - other.low) / 2.0;
  for (int i = 0; i < count_; i++) {
    const Plane& plane = planes_[size_t(i)];
    const dvec3 spread = glm::abs(plane.normal) * half;
    if (glm::dot(plane.normal, centre) + plane.offset < spread.x + spread.y + spread.z)
      return false;
  }
  return count_ > 0;
}

}  // namespace wellspring::scan
