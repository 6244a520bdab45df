// SPDX-License-Identifier: Apache-2.0
// Loops over cores (oneTBB). Bodies must not throw and must not depend on the order of their calls.
#pragma once
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace wellspring {

// body(begin, end) over disjoint pieces of [0, count), each of at least `grain` items where possible.
template <class Body>
void parallel_ranges(int count, int grain, const Body& body) {
  if (count <= 0) return;
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<int>(0, count, grain < 1 ? 1 : grain),
                            [&](const auto& range) { body(range.begin(), range.end()); });
}

// body(i) for every i in [0, count).
template <class Body>
void parallel_for(int count, const Body& body) {
  parallel_ranges(count, 1, [&](int begin, int end) {
    for (int i = begin; i < end; i++) body(i);
  });
}

}  // namespace wellspring
