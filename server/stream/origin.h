// SPDX-License-Identifier: Apache-2.0
// Who may open a WebSocket, or post: browsers name the page's origin and cannot be made to lie
// about it, so a page of somebody else's site cannot use its visitor's browser to reach this
// server. Scripts name none.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace wellspring {

// `origins`: every Origin header of the request; `host`: its Host header; `allowed`: one more
// origin that is welcome, "*" for any, empty for none. True without an origin, or with exactly one
// that names the same host and port as `host` (a port left out is the scheme's) or is `allowed`.
// Letter case does not count.
bool origin_allowed(const std::vector<std::string_view>& origins, std::string_view host,
                    std::string_view allowed);

// The offers of a Sec-WebSocket-Protocol header hold `wanted`.
bool offers_protocol(std::string_view header, std::string_view wanted);

}  // namespace wellspring
