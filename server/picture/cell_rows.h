// SPDX-License-Identifier: Apache-2.0
// Rows of cells (picture/cells.h) as groups of pixels read them, for picture/compose_drawn.cpp.
#pragma once
#include <cstring>

#include "picture/cells.h"
#include "picture/pixel_light.h"
#include "world/raster/raster.h"

namespace wellspring::picture {

// Pixels are lit in groups that lie between two columns of cell centres: four pixels, which are
// packed together, and four cells around. Groups begin half a cell before a tile, and two lie side
// by side in the lanes.
constexpr int half_cell = cell_size / 2;
constexpr int cells_together = lane_count / cell_size;
static_assert(cell_size == packed_four && cells_together == 2);

// What the lanes of two groups side by side have to the same side of them.
struct WideCell : CellLightOf<Lanes, LaneBits> {
  Lanes albedo[3];
};
inline void spread_cells(const PaintedCell& left, const PaintedCell& right, WideCell& to) {
  constexpr size_t count = sizeof(PaintedCell) / sizeof(float);
  static_assert(sizeof(WideCell) == count * sizeof(Lanes));
  float a[count], b[count];
  std::memcpy(a, &left, sizeof a), std::memcpy(b, &right, sizeof b);
  Lanes both[count];
  for (size_t i = 0; i < count; i++)
    both[i] = Lanes{a[i], a[i], a[i], a[i], b[i], b[i], b[i], b[i]};
  std::memcpy(static_cast<void*>(&to), both, sizeof both);
}

// Two rows of cells around a tile's blocks, each beside the one that the next group needs.
struct CellRows {
  static constexpr int most = RasterRun::most / cell_size + 3;
  uint64_t picture = 0;
  int first = 0, row = 0, count = 0;
  int above = 0;  // which of the rows
  WideCell cell[2][most];
  LaneMask
      flat[most];  // lanes of each group and those beside it that lie between cells in one plane

  const WideCell& at(int r, int k) const { return cell[above ^ r][k]; }
  void read(const PixelRays& rays, const Cells& cells, uint64_t of, int x, int y, int columns);

 private:
  void read_row(const Cells& cells, int y, WideCell* to) const;
};

inline void CellRows::read_row(const Cells& cells, int y, WideCell* to) const {
  PaintedCell before{}, here;
  for (int k = 0; k < count; k++, before = here) {
    read_cell(cells, first + k, y, here);
    size_t i = nearest_cell(cells, first + k, y);
    for (size_t n = 0; n < 3; n++) here.albedo[n] = cells.albedo[n][i];
    if (k > 0) spread_cells(before, here, to[k - 1]);
  }
}

inline void CellRows::read(const PixelRays& rays, const Cells& cells, uint64_t of, int x, int y,
                           int columns) {
  bool below = picture == of && first == x && row + 1 == y && count == columns;
  picture = of, first = x, row = y, count = columns;
  above = below ? above ^ 1 : 0;
  if (!below) read_row(cells, y, cell[above]);
  read_row(cells, y + 1, cell[above ^ 1]);
  int32_t one_plane[most + 2 * lane_count] = {};  // by groups
  for (int g = 0; g < count; g += lane_count)
    store_lanes(one_plane + g, find_flat(rays, cells, first + 1 + g, row + 1));
  for (int g = 0; g < count; g++)
    for (int k = 0; k < lane_count; k++) flat[g][k] = one_plane[g + k / cell_size];
}

}  // namespace wellspring::picture
