// SPDX-License-Identifier: Apache-2.0
// Sockets: HTTP and WebSocket on one port (Boost.Beast, in the .cpp files only). Knows nothing of
// rendering: questions go to Doors::answer, connected peers to Doors::joined as Links.
//
// What a stranger gets (limits not in StreamSettings are in session.h):
// - HTTP/1.1 with keep-alive, GET and HEAD only (405); header 16 KiB (431), body 64 KiB and ignored
//   (413); targets as in target.h. /api/v1/admin/announce takes a POST and nothing else: a body of
//   at most 16 KiB (413) of application/json (415), Origin as in origin.h (403). Every reply
//   carries the headers of reply.h; ETag and If-None-Match make a 304.
// - WebSocket at /api/v1/visit and /api/v1/eye; a plain GET there is told 426. Origin as in
// origin.h (403).
//   Subprotocol wellspring.v1 is echoed when offered; offering none is fine, offering only others
//   is a 400.
// - Close codes of a WebSocket: 1003 binary message, 1007 not UTF-8, 1008 more than 400 messages
// (pings count)
//   or 1 MiB a second for longer than a burst of two seconds' worth, 1009 message above 64 KiB,
//   1001 the server stops, 1000 the show closed the link.
// - A peer that is silent (not even pongs) is dropped after idle_timeout + half of it at most; one
// that does not
//   read what it is sent after write_timeout, whatever it says meanwhile.
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
  // Optional: questions that may take long. They get two threads and a short queue of their own, so
  // that pictures being made never keep a health check waiting. Both queues answer 503 when full.
  std::function<bool(const HttpQuestion&)> slow;
};

struct StreamSettings {
  std::string host = "127.0.0.1";
  uint16_t port = 8080;  // 0: any free one
  int threads = 2;
  int max_connections = 256;   // beyond: 503 and closed
  double header_timeout = 10;  // seconds for a request's header and body
  double write_timeout = 5;    // a WebSocket write pending longer closes the connection
  double idle_timeout = 20;    // a silent WebSocket is pinged after half of it, closed after all
  std::string allowed_origin;  // besides same-host: an Origin that may open WebSockets; "*": any
};

struct StreamCounters {  // since the start, but for open and websockets: now
  uint64_t accepted = 0, refused = 0, open = 0, http_requests = 0, websockets = 0, slow_closed = 0;
  uint64_t flood_closed = 0, accept_errors = 0;
};

// Throws what Server would throw if the port cannot be had now; else lets go of it again.
void try_port(const StreamSettings& settings);

class Server {
 public:
  // Binds and starts its threads. Throws std::runtime_error naming host, port and cause.
  Server(const StreamSettings& settings, Doors doors);
  ~Server();  // closes every connection (WebSockets with 1001) and joins
  uint16_t port() const;
  StreamCounters counters() const;
  // Idempotent: no more accepts, closes, joins; waits for answers under way. Not from within a
  // door.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
