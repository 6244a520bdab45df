// SPDX-License-Identifier: Apache-2.0
// Light of each lamp alone, averaged over cells of space and of a surface's main direction. Maps
// tell it at their own surfaces; cells tell it at any place that lies near some of them.
#pragma once
#include <cstdint>
#include <vector>

#include "light/sample/illumination_map.h"

namespace wellspring::light {

struct LampCells {
  float cell = 1;  // metres a side
  // place_key of each cell where find_place_slot() says, 0: free; and its number.
  std::vector<uint64_t> keys;
  std::vector<uint32_t> number_of;
  // Each cell has its key, the area of surface in it, and the light of what belongs to no lamp,
  // then of each lamp alone.
  std::vector<uint64_t> cells;
  std::vector<float> weight;
  std::vector<std::vector<vec3>> light;
};
inline constexpr uint32_t no_lamp_cell = 0xffffffffu;

// The light that `map` keeps of the world's still surfaces. Tenths of a second at most.
LampCells make_lamp_cells(const World& world, const IlluminationMap& map);
// The number of the cell of a surface there, or no_lamp_cell.
uint32_t find_lamp_cell(const LampCells& cells, vec3 place, vec3 normal);

}  // namespace wellspring::light
