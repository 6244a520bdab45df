// SPDX-License-Identifier: Apache-2.0
#include "collection/distances.h"

#include "base/parallel.h"
#include "collection/earth_mover.h"

namespace wellspring::collection {

Distances find_distances(const Sets& sets, std::span<const int> items) {
  Distances found;
  found.count = int(items.size());
  const size_t n = items.size();
  found.pairs.resize(n > 0 ? n * (n - 1) / 2 : 0);
  // A row and its counterpart from the end have together as many pairs as any other two.
  parallel_for(int((n + 1) / 2), [&](int half) {
    for (const size_t i : {size_t(half), n - 1 - size_t(half)}) {
      for (size_t k = 0; k < i; k++)
        found.pairs[i * (i - 1) / 2 + k] = earth_mover(sets[items[i]], sets[items[k]], sets.dims());
      if (n - 1 - i == i) break;
    }
  });
  return found;
}

}  // namespace wellspring::collection
