// SPDX-License-Identifier: Apache-2.0
// Runs loops over cores (oneTBB). Bodies must not throw and must not depend on the order of their
// calls. Between pieces, threads work on loops of high priority (base/worker.h).
#pragma once
#include <atomic>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>

#include "base/layers.h"
#endif

namespace wellspring {

// Orders a loop for the thread sanitizer, with which oneTBB is not built: pieces come after the
// code before the loop, and the code after the loop comes after the pieces.
class LoopOrder {
 public:
#ifdef __SANITIZE_THREAD__
  void reached() { __tsan_release(this); }
  void passed() { __tsan_acquire(this); }
#else
  void reached() {}
  void passed() {}
#endif
};

// May stay true too long: then a thread looks for a loop and finds none.
extern std::atomic<bool> loop_has_priority;
void help_priority_loop();
inline void help_priority() {
  if (loop_has_priority.load(std::memory_order_relaxed)) help_priority_loop();
}

// Calls body(begin, end) over disjoint pieces of [0, count), each of at least `grain` items if
// possible.
template <class Body>
void parallel_ranges(int count, int grain, const Body& body) {
  if (count <= 0) return;
  LoopOrder order;
  order.reached();
  oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<int>(0, count, grain < 1 ? 1 : grain),
                            [&](const auto& range) {
                              order.passed();
                              help_priority();
                              body(range.begin(), range.end());
                              order.reached();
                            });
  order.passed();
}

// Calls body(i) for every i in [0, count), each as a piece of its own: for bodies of a tenth of a
// millisecond and more. Pieces of several would leave cores without work at the end.
template <class Body>
void parallel_each(int count, const Body& body) {
  if (count <= 0) return;
  LoopOrder order;
  order.reached();
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<int>(0, count, 1),
      [&](const auto& range) {
        order.passed();
        for (int i = range.begin(); i < range.end(); i++) {
          help_priority();
          body(i);
        }
        order.reached();
      },
      oneapi::tbb::simple_partitioner());
  order.passed();
}

// Calls body(i) for every i in [0, count).
template <class Body>
void parallel_for(int count, const Body& body) {
  parallel_ranges(count, 1, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      if (i > begin) help_priority();
      body(i);
    }
  });
}

}  // namespace wellspring
