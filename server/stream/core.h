// SPDX-License-Identifier: Apache-2.0
// Holds what all sessions of one server share. Only for the .cpp files of this folder (heavy).
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "stream/address.h"
#include "stream/admission.h"
#include "stream/asio.h"
#include "stream/certificate.h"
#include "stream/stream.h"
#include "stream/target.h"
#include "stream/transport.h"

namespace wellspring::stream {

// Runs jobs on a few threads with a bounded queue, for work that may take long and must not hold up
// input and output.

class Workers {
 public:
  // A job is called once: with true on a worker, or with false if the workers stop before its turn.
  using Job = std::function<void(bool run)>;

  Workers(int threads, size_t max_waiting);
  ~Workers() { stop(); }
  bool post(Job job);  // false: full or stopped; the job is not kept
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

class Session;

struct Core {
  // Throws std::runtime_error for settings that make no sense.
  Core(const StreamSettings& settings, Doors doors);

  const StreamSettings settings;
  const Doors doors;
  const HostNames hosts;
  std::vector<Network> trusted, proxies;
  std::unique_ptr<Certificate> certificate;  // null: no TLS
  Admission admission;
  net::io_context io;
  Workers workers{4, 64}, slow_workers{2, 8};  // slow: see Doors::slow
  Workers health_workers{1, 16};               // health checks of trusted addresses

  std::atomic<uint64_t> accepted{0}, refused{0}, http_requests{0}, websockets{0}, slow_closed{0},
      flood_closed{0}, accept_errors{0}, next_link{1}, limited{0}, limited_in_all{0}, dropped{0},
      silent_closed{0};
  std::atomic<int> being_refused{0};  // connections that are being sent a refusal
  std::atomic<bool> proxy_told{false}, host_told{false};

  // Every session is listed from its start to its end, so that stop() can reach it and wait for it.
  std::mutex mutex;
  std::condition_variable session_ended;
  std::map<uint64_t, std::weak_ptr<Session>> sessions;
  bool stopping = false;
};

// Logs an error; at the debug level if the peer only went away.
void fail(const error_code& ec, const char* where);

}  // namespace wellspring::stream
