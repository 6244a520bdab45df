// SPDX-License-Identifier: Apache-2.0
// Loops that somebody waits for while all cores are at work on others. oneTBB sends its threads to
// them when their loop is done, which is too late for a picture that is due: threads within loops
// of base/parallel.h take pieces of an of high priority one as soon as they have finished one of
// their own.
#pragma once
#include <atomic>

#include "base/parallel.h"

namespace wellspring {

struct PriorityLoop {
  void (*run)(const void* body, int begin, int end) = nullptr;
  const void* body = nullptr;
  int count = 0, grain = 1;
  std::atomic<int> next{0};

  void work();  // until no piece is left
};
// Whoever asks for the loop's end afterwards waits for all threads that are at work on it.
void run_with_priority(PriorityLoop& loop);

// As parallel_ranges, but before all other loops. Pieces are of `grain` items: of a twentieth to
// a tenth of a millisecond, say. Bodies may be called on any thread, within any other loop, so they
// must not take locks, nor begin loops of their own. Of of high priority loops the first alone
// comes first.
template <class Body>
void priority_ranges(int count, int grain, const Body& body) {
  if (count <= 0) return;
  PriorityLoop loop;
  loop.run = [](const void* what, int begin, int end) {
    (*static_cast<const Body*>(what))(begin, end);
  };
  loop.body = &body;
  loop.count = count;
  loop.grain = grain < 1 ? 1 : grain;
  run_with_priority(loop);
}

}  // namespace wellspring
