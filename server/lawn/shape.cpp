// SPDX-License-Identifier: Apache-2.0
#include "lawn/shape.h"

namespace wellspring::lawn {

BladeShapes eval_wind_shapes(const Lawn& lawn, int first, const WindNow& wind) {
  const size_t at = size_t(first);
  const auto load = [at](const std::vector<float>& column) { return load_lanes(&column[at]); };
  BladeShapes shapes;
  shapes.length = load(lawn.length) * (1.0f / segments);
  shapes.joint[0] = {load(lawn.x), load(lawn.y), load(lawn.z)};
  Lanes push_x, push_z;
  wind.push_at(shapes.joint[0].x, shapes.joint[0].z, push_x, push_z);
  const Lanes give = load(lawn.give), droop = load(lawn.droop);
  const Lanes3 grow = {load(lawn.grow_x), load(lawn.grow_y), load(lawn.grow_z)};
  const Lanes bend_x = push_x * give - load(lawn.side_z) * droop,
              bend_z = push_z * give + load(lawn.side_x) * droop;
  for (int k = 0; k < segments; k++) {
    const float share = (float(k) + 0.5f) / segments;  // roots are stiff
    const Lanes3 way = {grow.x + bend_x * share, grow.y, grow.z + bend_z * share};
    shapes.joint[k + 1] = shapes.joint[k] + unit_lanes(way) * shapes.length;
  }
  return shapes;
}

}  // namespace wellspring::lawn
