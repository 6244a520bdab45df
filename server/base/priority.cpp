// SPDX-License-Identifier: Apache-2.0
#include "base/priority.h"

#include <algorithm>
#include <oneapi/tbb/task_arena.h>
#include <thread>

namespace wellspring {

namespace {
std::atomic<UrgentLoop*> urgent{nullptr};
std::atomic<int> helpers{0};  // threads that have looked at it
}  // namespace

std::atomic<bool> loop_is_urgent{false};

void UrgentLoop::work() {
  for (int begin; (begin = next.fetch_add(grain)) < count;)
    run(body, begin, std::min(begin + grain, count));
}

void help_urgent_loop() {
  helpers++;
  if (UrgentLoop* loop = urgent.load()) loop->work();
  helpers--;
}

void run_urgent(UrgentLoop& loop) {
  int pieces = (loop.count + loop.grain - 1) / loop.grain;
  UrgentLoop* none = nullptr;
  bool first = pieces > 1 && urgent.compare_exchange_strong(none, &loop);
  if (first) loop_is_urgent.store(true, std::memory_order_relaxed);
  // Threads without work come this way.
  int threads = std::min(oneapi::tbb::this_task_arena::max_concurrency(), pieces);
  if (threads > 1) parallel_for(threads, [&](int) { loop.work(); });
  loop.work();
  if (!first) return;
  loop_is_urgent.store(false, std::memory_order_relaxed);
  urgent = nullptr;
  while (helpers > 0) std::this_thread::yield();
}

}  // namespace wellspring
