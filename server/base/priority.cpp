// SPDX-License-Identifier: Apache-2.0
#include "base/priority.h"

#include <algorithm>
#include <oneapi/tbb/task_arena.h>
#include <thread>

namespace wellspring {

namespace {
std::atomic<PriorityLoop*> high_priority{nullptr};
std::atomic<int> helpers{0};  // threads that have looked at it
}  // namespace

std::atomic<bool> loop_has_priority{false};

void PriorityLoop::work() {
  for (int begin; (begin = next.fetch_add(grain)) < count;)
    run(body, begin, std::min(begin + grain, count));
}

void help_priority_loop() {
  helpers++;
  if (PriorityLoop* loop = high_priority.load()) loop->work();
  helpers--;
}

void run_with_priority(PriorityLoop& loop) {
  int pieces = (loop.count + loop.grain - 1) / loop.grain;
  PriorityLoop* none = nullptr;
  bool first = pieces > 1 && high_priority.compare_exchange_strong(none, &loop);
  if (first) loop_has_priority.store(true, std::memory_order_relaxed);
  // Threads without work come this way.
  int threads = std::min(oneapi::tbb::this_task_arena::max_concurrency(), pieces);
  if (threads > 1) parallel_for(threads, [&](int) { loop.work(); });
  loop.work();
  if (!first) return;
  loop_has_priority.store(false, std::memory_order_relaxed);
  high_priority = nullptr;
  while (helpers > 0) std::this_thread::yield();
}

}  // namespace wellspring
