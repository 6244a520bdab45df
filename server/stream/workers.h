// SPDX-License-Identifier: Apache-2.0
// A few threads and a bounded queue, for work that may take long and must not hold up input and
// output.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace wellspring::stream {

class Workers {
 public:
  // Called once: with true on a worker, or with false when the workers stop before it was its turn.
  using Job = std::function<void(bool run)>;

  Workers(int threads, size_t max_waiting);
  ~Workers() { stop(); }
  bool post(Job job);  // false: full or stopped, the job is not kept
  void stop();         // idempotent; waits for jobs under way

 private:
  void work();
  const size_t max_waiting_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Job> waiting_;
  bool stopped_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace wellspring::stream
