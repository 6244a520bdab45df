// SPDX-License-Identifier: Apache-2.0
// Where a kiosk's server is, as people write it.
#pragma once
#include <optional>
#include <string>

namespace wellspring::kiosk {

struct ServerAddress {
  std::string host, port = "80", path;
  bool tls = false;
};
// ws://HOST[:PORT][/PATH] or wss://, an IPv6 address in brackets; no path: /api/v1/eye; no port:
// 80, or 443. Nothing for anything else.
std::optional<ServerAddress> parse_address(const std::string& url);

}  // namespace wellspring::kiosk
