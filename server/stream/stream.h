// SPDX-License-Identifier: Apache-2.0
// Serves HTTP and WebSocket on one port (Boost.Beast, in the .cpp files only). Knows nothing of
// rendering: questions go to Doors::answer, connected peers to Doors::joined as Links.
//
// A stranger gets the following (limits not in StreamSettings are in session.h):
// - Names: a request whose Host is none of HostNames (target.h) gets 421, whatever it asks.
// - Limits by address and in all, a reserve for trusted addresses: admission.h. Anything beyond
//   gets 429 or 503 with Retry-After.
// - TLS if there is a certificate; plain requests are then sent to https:// (308), except those of
//   trusted addresses.
// - HTTP/1.1 with keep-alive, GET and HEAD only (405); header 16 KiB (431), body 64 KiB and ignored
//   (413), no Transfer-Encoding but chunked (501); targets as in target.h. /api/v1/admin/announce
//   takes a POST and nothing else: a body of at most 16 KiB (413) of application/json (415), Origin
//   as in target.h (403). Every reply carries the headers of reply.h; ETag and If-None-Match make a
//   304. Text goes as gzip to clients that accept it (reply.h).
// - WebSocket at /api/v1/visit and /api/v1/eye; a plain GET there gets 426. Origin as in target.h
//   (403). Subprotocol wellspring.v1 is echoed when offered; offering none is fine, offering only
//   others is a 400.
// - A WebSocket becomes a Link with its first message, which must come within
//   first_message_timeout.
// - Close codes of a WebSocket: 1003 binary message, 1007 not UTF-8, 1008 no first message, or more
//   than 400 frames of any kind or 1 MiB a second for longer than a burst of two seconds' worth, or
//   250 frames or 100 kB if all strangers together send too much (admission.h), or too much from
//   its address, 1009 message above 64 KiB, 1001 the server stops, 1000 the show closed the link.
// - A peer that is silent (not even pongs) is dropped after idle_timeout + half of it at most; one
//   that does not read what it is sent after write_timeout, whatever it sends meanwhile.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "stream/admission.h"
#include "wire/http.h"
#include "wire/link.h"

namespace wellspring::stream {

struct Doors {
  // Answers a question. Runs on a worker thread of its own pool, may take seconds; must not throw.
  std::function<HttpReply(const HttpQuestion&)> answer;
  // Optional: decides whether a WebSocket may be opened; without it every one may. Runs on an I/O
  // thread; must not block.
  std::function<UpgradeAnswer(const HttpQuestion&)> admit{};
  // Optional: is asked before `answer`, likewise on a worker thread, and must not take long. True:
  // it has taken the question, and answers the asker when it can, or not at all if the asker is
  // gone.
  std::function<bool(const HttpQuestion&, const std::shared_ptr<HttpAsker>&)> answer_later{};
  // Gets each peer that has passed the WebSocket handshake and sent a first message. Runs on an I/O
  // thread; must not block.
  std::function<void(std::shared_ptr<Link>)> joined;
  // Optional: says which questions may take long. They get two threads and a short queue of their
  // own, so that they never keep a health check waiting. Both queues answer 503 when full.
  std::function<bool(const HttpQuestion&)> slow{};
  // Optional: returns the line for callers of StreamSettings::agent_port; empty: nothing yet. Runs
  // on an I/O thread; must not block.
  std::function<std::string()> agent{};
};

struct StreamSettings {
  std::string host = "127.0.0.1";
  uint16_t port = 8080;     // 0: any free one
  uint16_t agent_port = 0;  // for HAProxy's agent-check; 0: none
  int threads = 2;
  double header_timeout = 10;  // seconds for a request's header and body
  double write_timeout = 5;    // a WebSocket write pending longer closes the connection
  double idle_timeout = 20;    // a silent WebSocket is pinged after half of it, closed after all
  double first_message_timeout = 10;  // seconds after the handshake of a WebSocket
  // Besides same-host, origins that may open WebSockets; "*": any.
  std::vector<std::string> allowed_origins;
  std::vector<std::string> allowed_hosts;  // names besides this machine's; "*": any
  Limits limits;
  bool trust_loopback = true;        // 127.0.0.1 and ::1 are trusted
  std::vector<std::string> trusted;  // addresses and networks without limits by address
  std::vector<std::string> proxies;  // proxies whose X-Forwarded-For is believed; likewise
  std::string certificate, key;      // files for TLS, in PEM; both or none
  double certificate_interval = 2;   // seconds between looks whether they have changed
};

struct StreamCounters {  // since the start, except open, websockets and addresses: now
  uint64_t accepted = 0, refused = 0, open = 0, http_requests = 0, websockets = 0, slow_closed = 0;
  uint64_t flood_closed = 0, accept_errors = 0;
  uint64_t limited = 0;         // requests and WebSockets refused by their address's limits
  uint64_t limited_in_all = 0;  // likewise, by the limits of all addresses together
  uint64_t dropped = 0;         // connections that waited and made place for others
  uint64_t silent_closed = 0;   // WebSockets that sent no first message
  uint64_t addresses = 0;       // addresses whose counts and rates are remembered
};
// Writes the counters in Prometheus' format.
std::string to_metrics(const StreamCounters& counters);

class Server {
 public:
  // Binds and starts its threads. Throws std::runtime_error naming host, port and cause.
  Server(const StreamSettings& settings, Doors doors);
  ~Server();  // closes every connection (WebSockets with 1001) and joins
  uint16_t port() const;
  StreamCounters counters() const;
  // Reads the certificate anew, if there is one; faults are logged, and the old one stays. From any
  // thread, returns at once.
  void reread_certificate();
  // Stops: accepts no more, closes, joins; waits for answers under way. Idempotent. Not from within
  // a function of Doors.
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::stream
