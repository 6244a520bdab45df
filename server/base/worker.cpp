// SPDX-License-Identifier: Apache-2.0
#include "base/worker.h"

#include <chrono>

namespace wellspring {

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

}  // namespace wellspring
