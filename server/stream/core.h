// SPDX-License-Identifier: Apache-2.0
// What all sessions of one server share. Only for the .cpp files of this folder (heavy).
#pragma once
#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "stream/address.h"
#include "stream/admission.h"
#include "stream/asio.h"
#include "stream/origin.h"
#include "stream/stream.h"
#include "stream/tls.h"
#include "stream/workers.h"

namespace wellspring::stream {

class Session;

struct Core {
  // Throws std::runtime_error for settings that mean nothing.
  Core(const StreamSettings& settings, Doors doors);

  const StreamSettings settings;
  const Doors doors;
  const HostNames hosts;
  std::vector<Network> trusted, proxies;
  std::unique_ptr<Certificate> certificate;  // null: no TLS
  Admission admission;
  net::io_context io;
  Workers workers{4, 64}, slow_workers{2, 8};  // slow: as Doors::slow says
  Workers health_workers{1, 16};               // for trusted addresses that ask how it is

  std::atomic<uint64_t> accepted{0}, refused{0}, http_requests{0}, websockets{0}, slow_closed{0},
      flood_closed{0}, accept_errors{0}, next_link{1}, limited{0}, limited_in_all{0}, dropped{0},
      silent_closed{0};
  std::atomic<int> being_refused{0};  // connections that are told so
  std::atomic<bool> proxy_told{false}, host_told{false};

  // Every session is listed from its start to its end, so that stop() can reach it and wait for it.
  std::mutex mutex;
  std::condition_variable session_ended;
  std::map<uint64_t, std::weak_ptr<Session>> sessions;
  bool stopping = false;
};

// Logs what went wrong; quietly where it is only the other side going away.
void fail(const error_code& ec, const char* where);

}  // namespace wellspring::stream
