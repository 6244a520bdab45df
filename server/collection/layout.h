// SPDX-License-Identifier: Apache-2.0
// A map of items by classical multidimensional scaling (Torgerson 1952; P06, section 2.3), and how
// far it is from the truth (Kruskal 1964).
#pragma once
#include <vector>

#include "base/vec.h"
#include "collection/distances.h"

namespace wellspring::collection {

inline constexpr int most_on_map = 1500;

// Holds places whose distances come near to those of the items; their mean is 0. The first axis is
// the longer; each has its largest place on its positive side.
struct Layout {
  std::vector<dvec2> places;
  double stress = 0;                // Kruskal's, of all pairs; 0: the map is true
  std::vector<double> item_stress;  // the same of each item's pairs
};

// Places the items by the two largest eigenpairs of the doubly centred squared distances. Items
// that are all equal lie at 0.
Layout lay_out(const Distances& distances);

}  // namespace wellspring::collection
