// SPDX-License-Identifier: Apache-2.0
#include "base/worker.h"

#include <algorithm>
#include <chrono>
#include <oneapi/tbb/task_arena.h>
#include <thread>
#include <utility>

namespace wellspring {

static thread_local std::stop_token of_thread;

CancelScope::CancelScope(std::stop_token token)
    : before_(std::exchange(of_thread, std::move(token))) {}
CancelScope::~CancelScope() { of_thread = std::move(before_); }

std::stop_token cancel_token() { return of_thread; }

void check_cancelled() {
  if (of_thread.stop_requested()) throw Cancelled{};
}

Worker::~Worker() {
  if (!thread_.joinable()) return;
  wait();
  {
    std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Worker::run(std::function<void()> work) {
  if (!thread_.joinable()) thread_ = std::thread([this] { live(); });
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !work_; });
  work_ = std::move(work);
  runs_++;
  lock.unlock();
  changed_.notify_all();
}

bool Worker::busy() const {
  std::lock_guard lock(mutex_);
  return bool(work_);
}

void Worker::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !work_; });
}

bool Worker::wait_for(double seconds) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !work_; });
}

void Worker::live() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return end_ || work_; });
    if (!work_) return;
    lock.unlock();
    work_();
    lock.lock();
    work_ = nullptr;
    changed_.notify_all();
  }
}

namespace {
std::atomic<PriorityLoop*> high_priority{nullptr};
std::atomic<int> helpers{0};  // threads that look at or work on the loop
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
  // Threads without work take part through an ordinary loop.
  int threads = std::min(oneapi::tbb::this_task_arena::max_concurrency(), pieces);
  if (threads > 1) parallel_for(threads, [&](int) { loop.work(); });
  loop.work();
  if (!first) return;
  loop_has_priority.store(false, std::memory_order_relaxed);
  high_priority = nullptr;
  while (helpers > 0) std::this_thread::yield();
}

}  // namespace wellspring
