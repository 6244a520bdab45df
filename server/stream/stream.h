// SPDX-License-Identifier: Apache-2.0
// Sockets: HTTP and WebSocket on one port (Boost.Beast, in the .cpp files only). Knows nothing of
// rendering: questions go to Doors::answer, connected peers to Doors::joined as Links.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "wire/http.h"
#include "wire/link.h"

namespace wellspring {

struct Doors {
  // Runs on a worker thread of its own pool, may take seconds (a still picture); must not throw.
  std::function<HttpReply(const HttpQuestion&)> answer;
  // A peer passed the WebSocket handshake. Runs on an I/O thread; must not block.
  std::function<void(std::shared_ptr<Link>)> joined;
};

struct StreamSettings {
  std::string host = "127.0.0.1";
  uint16_t port = 8080;  // 0: any free one
  int threads = 2;
  int max_connections = 256;          // beyond: 503 and closed
  double header_timeout = 10;         // seconds for a request's header and body
  double write_timeout = 5;           // a WebSocket write pending longer closes the connection
  std::string allowed_origin;         // besides same-host: an Origin that may open WebSockets; "*": any
};

struct StreamCounters {
  uint64_t accepted = 0, refused = 0, open = 0, http_requests = 0, websockets = 0, slow_closed = 0;
};

class Server {
 public:
  // Binds and starts its threads. Throws std::runtime_error naming host, port and cause.
  Server(const StreamSettings& settings, Doors doors);
  ~Server();  // closes every connection (WebSockets with 1001) and joins
  uint16_t port() const;
  StreamCounters counters() const;
  void stop();  // idempotent: no more accepts, closes, joins

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
