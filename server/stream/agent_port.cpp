// SPDX-License-Identifier: Apache-2.0
#include "stream/agent_port.h"

#include <stdexcept>

namespace wellspring::stream {

static constexpr auto pause_after_error = std::chrono::milliseconds(100);

void listen_on(net::io_context& io, const std::string& host, uint16_t port,
               tcp::acceptor& acceptor) {
  const auto throw_error = [&](const error_code& ec) {
    throw std::runtime_error("cannot listen on " + host + ":" + std::to_string(port) + ": " +
                             ec.message());
  };
  error_code ec;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(host, std::to_string(port),
                                      tcp::resolver::passive | tcp::resolver::numeric_service, ec);
  if (ec) throw_error(ec);
  ec = net::error::host_not_found;
  for (const auto& entry : found) {
    const tcp::endpoint endpoint = entry.endpoint();
    error_code ignored;
    acceptor.close(ignored);
    acceptor.open(endpoint.protocol(), ec);
    if (ec) continue;
    acceptor.set_option(net::socket_base::reuse_address(true), ignored);
    if (endpoint.protocol() == tcp::v6()) acceptor.set_option(net::ip::v6_only(false), ignored);
    acceptor.bind(endpoint, ec);
    if (!ec) acceptor.listen(net::socket_base::max_listen_connections, ec);
    if (!ec) break;
  }
  if (ec) throw_error(ec);
}

net::awaitable<void> tell_callers(tcp::acceptor& acceptor, std::function<std::string()> say) {
  net::steady_timer pause(acceptor.get_executor());
  while (acceptor.is_open()) {
    tcp::socket socket(acceptor.get_executor());
    error_code ec;
    co_await acceptor.async_accept(socket, net::redirect_error(net::use_awaitable, ec));
    if (ec && acceptor.is_open()) {
      pause.expires_after(pause_after_error);
      co_await pause.async_wait(net::redirect_error(net::use_awaitable, ec));
      continue;
    }
    std::string line = say();
    if (ec || line.empty()) continue;
    line += '\n';
    // A few bytes, which a new connection's buffer takes at once: nobody keeps the next waiting.
    socket.non_blocking(true, ec);
    socket.write_some(net::buffer(line), ec);
    socket.shutdown(tcp::socket::shutdown_send, ec);
  }
}

}  // namespace wellspring::stream
