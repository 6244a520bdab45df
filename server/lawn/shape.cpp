// SPDX-License-Identifier: Apache-2.0
#include "lawn/shape.h"

namespace wellspring::lawn {
namespace {

// Returns the share of a push that turns a segment: roots are stiff.
constexpr float stiffness_share(int segment) { return (float(segment) + 0.5f) / segments; }

}  // namespace

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
    const float share = stiffness_share(k);
    const Lanes3 way = {grow.x + bend_x * share, grow.y, grow.z + bend_z * share};
    shapes.joint[k + 1] = shapes.joint[k] + unit_lanes(way) * shapes.length;
  }
  return shapes;
}

BladeSway eval_sway(const Lawn& lawn, int first, const BladeShapes& shapes) {
  const size_t at = size_t(first);
  const Lanes give = load_lanes(&lawn.give[at]);
  // A segment's way has the height that the blade grows up, so its length follows from its slope.
  const Lanes grow_up = lanes_max(load_lanes(&lawn.grow_y[at]), all_lanes(0.1f));
  BladeSway sway;
  sway.joint[0] = Lanes{};
  for (int k = 0; k < segments; k++) {
    const Lanes up = positive_lanes(unit_lanes(shapes.joint[k + 1] - shapes.joint[k]).y);
    const Lanes aside = 0.5f * (1.0f + up * up);  // share of a push that is across the segment
    sway.joint[k + 1] = sway.joint[k] + stiffness_share(k) * give * shapes.free * shapes.length *
                                            up * aside / grow_up;
  }
  return sway;
}

}  // namespace wellspring::lawn
