// SPDX-License-Identifier: Apache-2.0
// Nodes beside a node, in its tile.
#pragma once
#include <algorithm>

#include "light/sample/illumination_map.h"

namespace wellspring::light {

// Calls visit(node beside) for the up to eight nodes around node `i` of the tile.
template <class Visit>
void for_each_beside(const IlluminationTile& tile, uint32_t i, const Visit& visit) {
  const int columns = tile.columns + 1, rows = tile.rows + 1;
  const int x = int(i) % columns, y = int(i) / columns;
  for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows - 1); row++)
    for (int column = std::max(x - 1, 0); column <= std::min(x + 1, columns - 1); column++)
      if (row != y || column != x) visit(uint32_t(row * columns + column));
}

}  // namespace wellspring::light
