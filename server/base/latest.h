// SPDX-License-Identifier: Apache-2.0
// A one-slot mailbox between two threads: the newest value wins, an unread older one is dropped.
// put() and take() never block for longer than a pointer swap.
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace wellspring {

template <class T>
class Latest {
 public:
  // Returns true when it replaced a value nobody had taken.
  bool put(T value) {
    std::lock_guard lock(mutex_);
    bool dropped = slot_.has_value();
    slot_ = std::move(value);
    dropped_ += dropped;
    return dropped;
  }
  std::optional<T> take() {
    std::lock_guard lock(mutex_);
    return std::exchange(slot_, std::nullopt);
  }
  bool full() const {
    std::lock_guard lock(mutex_);
    return slot_.has_value();
  }
  uint64_t dropped() const {
    std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<T> slot_;
  uint64_t dropped_ = 0;
};

}  // namespace wellspring
