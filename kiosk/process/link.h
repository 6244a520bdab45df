// SPDX-License-Identifier: Apache-2.0
// Keeps a WebSocket to the server open, by TLS if its address says so, in a thread of its own. The
// newest text wins, there is no queue, no call blocks; a lost connection is tried again after a
// pause that doubles up to a limit, with jitter so that many kiosks do not come back in step.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "wire/messages.h"

namespace wellspring::kiosk {

// Reads the address of a kiosk's server, as people write it.

struct ServerAddress {
  std::string host, port = "80", path;
  bool tls = false;
};
// Reads ws://HOST[:PORT][/PATH] or wss://, an IPv6 address in brackets; no path: /api/v1/eye; no
// port: 80, or 443. Returns nothing for anything else.
std::optional<ServerAddress> parse_address(const std::string& url);

// Returns the seconds to wait before attempt 1, 2, ...: first * 2^(attempt - 1), at most `longest`,
// times 0.5 to 1 by `jitter` (0..1).
double retry_pause(int attempt, double first, double longest, double jitter);

struct ServerLinkSettings {
  double first_pause = 0.25, longest_pause = 5;  // seconds
  double patience = 5;                           // seconds for connecting and for a write
  std::string token{};                           // shown to the server; empty: none
  // PEM file of who must have signed the server's certificate; empty: the system's
  std::string ca_file{};
  // Path of a document of the server's that is asked for whenever the server is there (again);
  // empty: none
  std::string document{};
};

class ServerLink {
 public:
  // Throws std::runtime_error that names a ca_file that cannot be used.
  explicit ServerLink(const ServerAddress& address, const ServerLinkSettings& settings = {});
  ~ServerLink();  // sends what is left and says goodbye, at most one second
  void send(std::string text);
  // Returns the newest order of the server not taken yet; its other messages are dropped.
  std::optional<EyeOrder> take_order();
  // Returns the document, as it came with the last connection and was not taken yet; empty text:
  // the server has none. Documents have at most 32 MiB.
  std::optional<std::string> take_document();
  bool connected() const;
  uint64_t sent() const;         // texts written
  uint64_t connections() const;  // handshakes that succeeded

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::kiosk
