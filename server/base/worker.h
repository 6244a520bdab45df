// SPDX-License-Identifier: Apache-2.0
// One thread of its own that does one thing at a time, for work that goes on while its owner does
// others: scheduled by the system, so that it neither waits for cores that are busy with parallel
// loops nor is waited for by them. All calls come from the owner's thread.
#pragma once
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace wellspring {

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

}  // namespace wellspring
