// SPDX-License-Identifier: Apache-2.0
// The means of an import's stages: memory that is counted, work on several threads that may fail.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>

#include "base/parallel.h"
#include "base/worker.h"
#include "scan/tree/tree_settings.h"

namespace wellspring::scan {

// Counts the bytes of large arrays.
class HeldBytes {
 public:
  void add(uint64_t bytes) {
    const uint64_t now = held_ += bytes;
    uint64_t most = most_.load();
    while (now > most && !most_.compare_exchange_weak(most, now)) {}
  }
  void remove(uint64_t bytes) { held_ -= bytes; }
  uint64_t most() const { return most_; }

 private:
  std::atomic<uint64_t> held_{0}, most_{0};
};

class Hold {
 public:
  Hold(HeldBytes& held, uint64_t bytes) : held_(held), bytes_(bytes) { held_.add(bytes_); }
  ~Hold() { held_.remove(bytes_); }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;
  void grow(uint64_t bytes) { held_.add(bytes), bytes_ += bytes; }

 private:
  HeldBytes& held_;
  uint64_t bytes_;
};

// Tells progress by one thread at a time, and ends the work if the caller's token says so.
class StageProgress {
 public:
  explicit StageProgress(const TreeProgress& tell) : tell_(tell), token_(cancel_token()) {}
  // Begins a stage, which takes the work from one share to another.
  void begin(const char* stage, double from, double to, uint64_t items) {
    stage_ = stage, from_ = from, to_ = to, items_ = std::max<uint64_t>(items, 1), done_ = 0;
  }
  void add(uint64_t items) {
    if (token_.stop_requested()) throw Cancelled();
    std::lock_guard lock(mutex_);
    done_ += items;
    const double share = std::min(1.0, double(done_) / double(items_));
    if (tell_) tell_(from_ + (to_ - from_) * share, stage_);
  }

 private:
  const TreeProgress& tell_;
  std::stop_token token_;
  std::mutex mutex_;
  const char* stage_ = "";
  double from_ = 0, to_ = 1;
  uint64_t items_ = 1, done_ = 0;
};

// Calls body(i) for every i in [0, count) on at most so many threads, beginning in the order of
// numbers. If one throws, no more begin, and the first exception is thrown to the caller.
template <class Body>
void run_in_order(size_t count, int threads, const Body& body) {
  std::atomic<size_t> next{0};
  std::atomic<bool> fails{false};
  std::exception_ptr error;
  std::mutex mutex;
  parallel_each(int(std::min<size_t>(size_t(std::max(threads, 1)), count)), [&](int) {
    for (size_t i; !fails && (i = next++) < count;) try {
        body(i);
      } catch (...) {
        std::lock_guard lock(mutex);
        if (!error) error = std::current_exception();
        fails = true;
      }
  });
  if (error) std::rethrow_exception(error);
}

}  // namespace wellspring::scan
