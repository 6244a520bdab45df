// SPDX-License-Identifier: Apache-2.0
// Picks an index with probability proportional to its weight in constant time (Walker 1977, built
// as Vose 1991). Weights that are negative or not finite count as 0.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace wellspring::light {

struct AliasTable {
  struct Cell {
    float keep = 1;         // chance that this cell stands for itself
    uint32_t other = 0;     // otherwise
    float probability = 0;  // of this index, over the whole table
  };
  std::vector<Cell> cells;  // empty: all weights are 0
  double total = 0;         // sum of the weights
};

AliasTable make_alias_table(std::span<const float> weights);

struct AliasPick {
  uint32_t index;
  float u;  // what is left of the number: uniform again
};
// The table must not be empty. u in [0, 1).
inline AliasPick sample_alias(const AliasTable& table, float u) {
  float scaled = u * float(table.cells.size());
  uint32_t i = uint32_t(scaled);
  if (i >= table.cells.size()) i = uint32_t(table.cells.size() - 1);
  float rest = scaled - float(i);
  const AliasTable::Cell& cell = table.cells[i];
  if (rest < cell.keep) return {i, rest / cell.keep};
  return {cell.other, (rest - cell.keep) / (1 - cell.keep)};
}

}  // namespace wellspring::light
