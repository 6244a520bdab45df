// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/ring_sweep.h"

namespace wellspring::volume {

std::vector<ColorLanes> gather_rays(const RingSystem& system, std::span<const ColorLanes> light) {
  std::vector<ColorLanes> gathered(size_t(system.rays));
  parallel_each(int(system.pieces.size()), [&](int piece) {
    const RingRows& rows = system.pieces[size_t(piece)];
    for (size_t row = 0; row + 1 < rows.begin.size(); ++row)
      gathered[size_t(rows.first_ray) + row] = gather_row(rows, row, light.data());
  });
  return gathered;
}

}  // namespace wellspring::volume
