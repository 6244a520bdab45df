// SPDX-License-Identifier: Apache-2.0
#include "stream/core.h"

#include <exception>

#include "base/log.h"

namespace wellspring::stream {

Workers::Workers(int threads, size_t max_waiting) : max_waiting_(max_waiting) {
  for (int i = 0; i < threads; i++) threads_.emplace_back([this] { work(); });
}

bool Workers::post(Job job) {
  {
    std::lock_guard lock(mutex_);
    if (stopped_ || waiting_.size() >= max_waiting_) return false;
    waiting_.push_back(std::move(job));
  }
  news_.notify_one();
  return true;
}

void Workers::work() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      news_.wait(lock, [this] { return stopped_ || !waiting_.empty(); });
      if (stopped_) return;
      job = std::move(waiting_.front());
      waiting_.pop_front();
    }
    try {
      job(true);
    } catch (const std::exception& e) {
      log::error("worker: {}", e.what());
    }
  }
}

void Workers::stop() {
  std::deque<Job> left;
  {
    std::lock_guard lock(mutex_);
    stopped_ = true;
    left.swap(waiting_);
  }
  news_.notify_all();
  for (auto& thread : threads_)
    if (thread.joinable()) thread.join();
  for (auto& job : left) job(false);
}

}  // namespace wellspring::stream
