// SPDX-License-Identifier: Apache-2.0
// The way to the server: a WebSocket, by TLS where its address says so, that is kept open in a
// thread of its own. The newest text wins, nothing queues, no call blocks; a lost connection is
// tried again after a pause that doubles up to a limit, with jitter so that many kiosks do not come
// back in step.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wire/messages.h"

namespace wellspring::kiosk {

// Where a kiosk's server is, as people write it.

struct ServerAddress {
  std::string host, port = "80", path;
  bool tls = false;
};
// ws://HOST[:PORT][/PATH] or wss://, an IPv6 address in brackets; no path: /api/v1/eye; no port:
// 80, or 443. Nothing for anything else.
std::optional<ServerAddress> parse_address(const std::string& url);

// Seconds to wait before attempt 1, 2, ...: first * 2^(attempt - 1), at most `longest`, times 0.5
// to 1 by `jitter` (0..1).
double retry_pause(int attempt, double first, double longest, double jitter);

struct ServerLinkSettings {
  double first_pause = 0.25, longest_pause = 5;  // seconds
  double patience = 5;                           // for connecting and for a write
  std::string token{};                           // shown to the server; empty: none
  std::string ca_file{};  // PEM: who must have signed its certificate; empty: one of the system's
};

class ServerLink {
 public:
  // Throws std::runtime_error that names a ca_file that cannot be used.
  explicit ServerLink(const ServerAddress& address, const ServerLinkSettings& settings = {});
  ~ServerLink();  // sends what is left and says goodbye, at most one second
  void send(std::string text);
  // The newest order of the server that was not taken yet; what else it says is forgotten.
  std::optional<EyeOrder> take_order();
  bool connected() const;
  uint64_t sent() const;         // texts written
  uint64_t connections() const;  // handshakes that succeeded

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
