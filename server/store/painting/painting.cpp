// SPDX-License-Identifier: Apache-2.0
#include "store/painting/painting.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace wellspring::store {

PaintBox PaintPlacement::apply(const PaintBox& box) const {
  PaintBox turned;
  if (box.empty()) return turned;
  for (dvec2 p : {box.low, box.high, dvec2(box.low.x, box.high.y), dvec2(box.high.x, box.low.y)})
    turned.add(apply(p));
  return turned;
}

PaintPlacement PaintPlacement::inverse() const {
  const double area = across.x * down.y - across.y * down.x;
  PaintPlacement back{dvec2(down.y, -across.y) / area, dvec2(-down.x, across.x) / area, dvec2(0)};
  back.at = -back.turn(at);
  return back;
}

PaintBox PaintPath::bounds() const {
  PaintBox box;
  for (dvec2 point : points) box.add(point);
  return box;
}

double paint_chance(uint64_t seed, int64_t a, int64_t b, int c) {
  return double(sample_seed(seed, uint32_t(a), uint32_t(b), uint32_t(c)) >> 11) * 0x1p-53;
}

}  // namespace wellspring::store
