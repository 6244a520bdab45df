// SPDX-License-Identifier: Apache-2.0
// Serves a port that sends every caller one line and ends the connection: HAProxy's agent-check.
// Only for the .cpp files of this folder (heavy).
#pragma once
#include <functional>
#include <string>

#include "stream/asio.h"

namespace wellspring::stream {

// Binds and listens, at the first of the host's addresses that works. Throws std::runtime_error
// naming host, port and cause.
void listen_on(net::io_context& io, const std::string& host, uint16_t port,
               tcp::acceptor& acceptor);

// Accepts until the acceptor is closed. `say`: returns the line, without its end; empty: nothing is
// sent yet. It runs on an I/O thread and must not block.
net::awaitable<void> tell_callers(tcp::acceptor& acceptor, std::function<std::string()> say);

}  // namespace wellspring::stream
