// SPDX-License-Identifier: Apache-2.0
// Gets files from HTTP servers that a curator has named: RFC 9110, HTTP/1.1, with TLS for https.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers.h"

namespace wellspring::store {

struct HttpAddress {
  bool tls = false;
  std::string host;        // small letters; an IPv6 address without its brackets
  uint16_t port = 0;       // 80 or 443 where the address names none
  std::string path = "/";  // with the question behind it
};

bool is_http_address(std::string_view text);
// Takes an address apart: http or https, without user names; nothing if it is none. Leaves out
// a # and what stands behind it.
std::optional<HttpAddress> read_http_address(std::string_view text);
// Returns HOST, or HOST:PORT where the port is not the usual one.
std::string host_text(const HttpAddress& address);
// Says whether `hosts` has the address's HOST:PORT, or HOST where the port is 80 or 443.
bool is_allowed(const HttpAddress& address, const std::vector<std::string>& hosts);

struct HttpLimits {
  std::vector<std::string> hosts;        // hosts that may be asked
  size_t most_bytes = size_t(16) << 20;  // bytes of a body
  double seconds = 10;                   // for all of it, redirects included
  std::string accept = "*/*";
};

// Gets a file; waits for it. Follows redirects to the same host only, never from https to http.
// Returns nothing for 404 and 410. Throws a LoadError that names the address for a host that is not
// allowed, another status, a body that is too long, a connection that breaks or takes too long.
// Looking up a name may take longer than the limit, as long as the system's resolver takes.
std::optional<std::vector<uint8_t>> http_get(const std::string& address, const HttpLimits& limits);

}  // namespace wellspring::store
