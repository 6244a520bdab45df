// SPDX-License-Identifier: Apache-2.0
// Runs one thing at a time on a thread of its own, for work that goes on while its owner does other
// things: the system schedules the thread, so that it neither waits for cores that are busy with
// parallel loops nor is waited for by these loops. All calls come from the owner's thread.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "base/parallel.h"

namespace wellspring {

// Cancels long work such as loading an exhibit. Whoever begins it opens a CancelScope; the code
// within, however deep, calls check_cancelled() between steps of at most some tenths of a second,
// and so ends with the exception Cancelled.

// Is no std::exception, so that nobody takes it for an error of the work.
struct Cancelled {};

// Lets `token` cancel the calling thread's work until the scope ends.
class CancelScope {
 public:
  explicit CancelScope(std::stop_token token);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  std::stop_token before_;
};

// Returns the innermost scope's token, for other threads that help; without a scope one that never
// says stop.
std::stop_token cancel_token();
// Throws Cancelled if the calling thread's work is to end. Do not call it within loops over cores,
// whose bodies must not throw.
void check_cancelled();

class Worker {
 public:
  Worker() = default;
  ~Worker();  // waits for the work
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Begins `work` when the work before is done. `work` must not throw. The first call starts the
  // thread.
  void run(std::function<void()> work);
  uint64_t runs() const { return runs_; }  // number of works begun so far
  // After any of these has said that the work is done, its results may be read.
  bool busy() const;
  void wait() const;
  bool wait_for(double seconds) const;  // false: the work is still going on

 private:
  void live();
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::function<void()> work_;  // empty: nothing to do
  bool end_ = false;
  uint64_t runs_ = 0;
  std::thread thread_;
};

// Runs loops of high priority, that somebody waits for while all cores are at work on others.
// oneTBB sends its threads to them only when their own loop is done, which is too late for a
// picture that is due: so threads within loops of base/parallel.h take pieces of a loop of high
// priority as soon as they have finished a piece of their own.

struct PriorityLoop {
  void (*run)(const void* body, int begin, int end) = nullptr;
  const void* body = nullptr;
  int count = 0, grain = 1;
  std::atomic<int> next{0};

  void work();  // runs pieces until none is left
};
// Runs the loop, and returns when all threads that work on it have ended.
void run_with_priority(PriorityLoop& loop);

// Does the same as parallel_ranges, but before all other loops. Pieces have `grain` items, which
// should take a twentieth to a tenth of a millisecond. Bodies may be called on any thread, within
// any other loop, so they must not take locks, nor begin loops of their own. If there are several
// loops of high priority, only the first runs before others.
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

// Passes values between two threads through one slot: the newest value wins, an unread older one is
// dropped. put() and take() never block for longer than a pointer swap.

template <class T>
class Latest {
 public:
  // Returns true if it replaced a value that nobody had taken.
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
