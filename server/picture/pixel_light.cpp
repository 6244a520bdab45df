// SPDX-License-Identifier: Apache-2.0
#include "picture/pixel_light.h"

namespace wellspring::picture {

LaneMask find_flat(const PixelRays& rays, const Cells& cells, int bx, int by) {
  constexpr float same_direction = 0.998f, same_depth = 0.1f * plane_tolerance;
  auto at = [&](const auto& plane, size_t i) { return load_lanes(plane.data() + i); };
  size_t a = size_t(cells.index(bx - 1, by - 1));
  LaneBits object = load_lanes<LaneBits>(&cells.object[a]);
  Lanes nx = at(cells.normal[0], a), ny = at(cells.normal[1], a), nz = at(cells.normal[2], a),
        px = at(cells.plane[0], a), py = at(cells.plane[1], a), pz = at(cells.plane[2], a);
  Lanes left = rays.x((float(bx) - 0.5f) * cell_size) +
               float(cell_size) * rays.inverse_focal * Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  LaneMask flat = object != no_object;
  for (int k = 1; k < 4; k++) {
    size_t c = a + size_t(k & 1) + size_t(k >> 1) * size_t(cells.stride);
    Lanes x = left + float(k & 1) * float(cell_size) * rays.inverse_focal;
    float y = rays.y((float(by + (k >> 1)) - 0.5f) * cell_size);
    Lanes cosine =
        nx * at(cells.normal[0], c) + ny * at(cells.normal[1], c) + nz * at(cells.normal[2], c);
    Lanes off = at(cells.depth, c) * (px * x + py * y + pz) - 1.0f;
    flat &= (object == load_lanes<LaneBits>(&cells.object[c])) & (cosine >= same_direction) &
            (lanes_abs(off) < same_depth);
  }
  return flat;
}

}  // namespace wellspring::picture
