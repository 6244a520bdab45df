// SPDX-License-Identifier: Apache-2.0
#include "light/random/warp.h"

#include <cmath>

namespace wellspring::light {

AliasTable make_alias_table(std::span<const float> weights) {
  AliasTable table;
  auto usable = [](float w) { return w > 0 && std::isfinite(w) ? double(w) : 0.0; };
  for (float w : weights) table.total += usable(w);
  if (!(table.total > 0)) return table;
  size_t count = weights.size();
  table.cells.resize(count);
  std::vector<double> share(count);
  std::vector<uint32_t> small, large;
  for (size_t i = 0; i < count; i++) {
    double p = usable(weights[i]) / table.total;
    table.cells[i] = {1, uint32_t(i), float(p)};
    share[i] = p * double(count);
    (share[i] < 1 ? small : large).push_back(uint32_t(i));
  }
  while (!small.empty() && !large.empty()) {
    uint32_t s = small.back(), l = large.back();
    small.pop_back();
    table.cells[s].keep = float(share[s]);
    table.cells[s].other = l;
    share[l] -= 1 - share[s];
    if (share[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // An index that rounding leaves over stands for itself, unless its weight is 0.
  uint32_t heaviest = 0;
  for (uint32_t i = 1; i < count; i++)
    if (table.cells[i].probability > table.cells[heaviest].probability) heaviest = i;
  for (uint32_t i : small)
    if (table.cells[i].probability == 0) table.cells[i] = {0, heaviest, 0};
  return table;
}

}  // namespace wellspring::light
