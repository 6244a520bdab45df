// SPDX-License-Identifier: Apache-2.0
// Splits the target of a request line ("/a/b?c=d") into path and query. Strict, so that callers may
// append the path to a folder's name: decoded once, no "." or ".." or empty segments, no backslash,
// no control characters, no encoded slash, nothing that a second decoding would turn into one of
// these.
#pragma once
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

inline constexpr size_t max_target_bytes = 2048;  // longer: 414
inline constexpr size_t max_query_fields = 32;    // more: 400

// Fills path and query. Returns 200, or the status to refuse with (400, 414).
int read_target(std::string_view target, HttpQuestion& question);

// Decides who may open a WebSocket, or post: browsers name the page's origin and cannot be made to
// lie about it, so a page of a foreign site cannot use its visitor's browser to reach this server.
// Scripts name no origin. Also holds the names under which this server answers at all: a foreign
// name that is made to lead here (DNS rebinding) would make a foreign page one of ours.

// Returns whether the origin is allowed. `origins`: every Origin header of the request; `host`: its
// Host header; `allowed`: more origins that are welcome, "*" for any. True without an origin, or
// with exactly one that names the same host and port as `host` (a port left out is the scheme's) or
// is one of `allowed`. Letter case does not count.
bool origin_allowed(const std::vector<std::string_view>& origins, std::string_view host,
                    const std::vector<std::string>& allowed);

// Holds the names under which the server may be asked: addresses, "localhost", this machine's name
// (also without its domain, and as NAME.local), the one it listens on, those of `origins`, and
// `hosts`, in which "*" is any. Ports and letter case do not count, nor a dot at the end.
class HostNames {
 public:
  HostNames(const std::vector<std::string>& hosts, const std::vector<std::string>& origins,
            const std::string& listens_on);
  bool hold(std::string_view host_header) const;

 private:
  void add(std::string name);
  std::set<std::string> names_;
  bool any_ = false;
};

// Returns the name of a Host header without its port, in small letters; empty: it is no name. The
// result consists of letters, digits and ".-_:[]".
std::string host_name(std::string_view host_header);

// Returns whether a request comes from the machine that serves it. `peer`: "address:port";
// `proxied`: it has a header that proxies add; `host`: its Host header. A foreign page whose name
// suddenly leads to this machine (DNS rebinding) has a Host that is not this machine's.
bool is_from_this_machine(std::string_view peer, bool proxied, std::string_view host);
// Returns whether it is a header by which a proxy names its client.
bool is_proxy_header(std::string_view name);

// Returns whether the offers of a Sec-WebSocket-Protocol header contain `wanted`.
bool offers_protocol(std::string_view header, std::string_view wanted);

}  // namespace wellspring::stream
