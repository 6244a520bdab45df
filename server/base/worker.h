// SPDX-License-Identifier: Apache-2.0
// One thread of its own that does one thing at a time, for work that goes on while its owner does
// others: scheduled by the system, so that it neither waits for cores that are busy with parallel
// loops nor is waited for by them. All calls come from the owner's thread.
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

// Long work that may be cancelled, such as loading an exhibit. Who begins it opens a CancelScope;
// what is done within, however deep, asks check_cancelled() between steps of at most some tenths of
// a second, and so ends with the exception Cancelled.

// No std::exception: nobody takes it for something that is wrong with the work.
struct Cancelled {};

// What the calling thread does until the scope ends may be cancelled by `token`.
class CancelScope {
 public:
  explicit CancelScope(std::stop_token token);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  std::stop_token before_;
};

// The innermost scope's, for other threads that help; without a scope one that never says stop.
std::stop_token cancel_token();
// Throws Cancelled where the calling thread's work is to end. Not from within loops over cores,
// whose bodies must not throw.
void check_cancelled();

class Worker {
 public:
  Worker() = default;
  ~Worker();  // waits for the work
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Begins when the work before is done. `work` must not throw. The first call starts the thread.
  void run(std::function<void()> work);
  uint64_t runs() const { return runs_; }  // how many there have been
  // What the work wrote may be read after any of these has said that it is done.
  bool busy() const;
  void wait() const;
  bool wait_for(double seconds) const;  // false: it is still going on

 private:
  void live();
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::function<void()> work_;  // empty: nothing to do
  bool end_ = false;
  uint64_t runs_ = 0;
  std::thread thread_;
};

// Loops that somebody waits for while all cores are at work on others. oneTBB sends its threads to
// them when their loop is done, which is too late for a picture that is due: threads within loops
// of base/parallel.h take pieces of an of high priority one as soon as they have finished one of
// their own.

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

// A one-slot mailbox between two threads: the newest value wins, an unread older one is dropped.
// put() and take() never block for longer than a pointer swap.

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
