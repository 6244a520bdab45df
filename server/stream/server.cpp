// SPDX-License-Identifier: Apache-2.0
// Listens, accepts, and ends everything in order.
#include <stdexcept>
#include <thread>

#include "base/log.h"
#include "stream/session.h"

namespace wellspring {

// Connections being told 503 at a time; more are just closed.
static constexpr size_t max_refusals = 64;
static constexpr auto accept_pause = std::chrono::milliseconds(100);
static constexpr auto polite_stop = std::chrono::seconds(1);
static constexpr auto forced_stop = std::chrono::seconds(5);

struct Server::Impl {
  std::shared_ptr<Core> core;
  net::executor_work_guard<net::io_context::executor_type> work;
  tcp::acceptor acceptor;
  uint16_t port = 0;
  std::vector<std::thread> threads;
  std::once_flag stopped;

  Impl(const StreamSettings& settings, Doors doors)
      : core(std::make_shared<Core>(settings, std::move(doors))),
        work(core->io.get_executor()),
        acceptor(net::make_strand(core->io)) {}

  void listen();
  net::awaitable<void> accept();
  void admit(tcp::socket socket, uint64_t id);
  void stop();
  template <class Duration>
  bool wait_until_empty(Duration limit);
  void stop_sessions(bool politely);
};

// Binds and listens. Throws std::runtime_error.
static void listen_on(net::io_context& io, const StreamSettings& settings,
                      tcp::acceptor& acceptor) {
  const auto throw_error = [&](const error_code& ec) {
    throw std::runtime_error("cannot listen on " + settings.host + ":" +
                             std::to_string(settings.port) + ": " + ec.message());
  };
  error_code ec;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(settings.host, std::to_string(settings.port),
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

void try_port(const StreamSettings& settings) {
  net::io_context io;
  tcp::acceptor acceptor(io);
  listen_on(io, settings, acceptor);
}

void Server::Impl::listen() {
  listen_on(core->io, core->settings, acceptor);
  port = acceptor.local_endpoint().port();
}

// Never ends on an error: a server that lives on with its door closed looks healthy and is not.
net::awaitable<void> Server::Impl::accept() {
  net::steady_timer pause(acceptor.get_executor());
  uint64_t errors_in_a_row = 0;
  for (uint64_t id = 1; acceptor.is_open(); id++) {
    tcp::socket socket(net::make_strand(core->io));
    error_code ec;
    co_await acceptor.async_accept(socket, net::redirect_error(net::use_awaitable, ec));
    if (!acceptor.is_open()) break;
    if (!ec) {
      errors_in_a_row = 0;
      admit(std::move(socket), id);
      continue;
    }
    core->accept_errors++;
    if (ec == net::error::connection_aborted) continue;  // came and went
    if (errors_in_a_row++ % 50 == 0)
      log::warn("accept: {}; trying again every {} ms", ec.message(), accept_pause.count());
    pause.expires_after(accept_pause);
    co_await pause.async_wait(net::redirect_error(net::use_awaitable, ec));
  }
}

void Server::Impl::admit(tcp::socket socket, uint64_t id) {
  error_code ec;
  const tcp::endpoint remote = socket.remote_endpoint(ec);
  if (ec) return;
  socket.set_option(tcp::no_delay(true), ec);
  core->accepted++;
  bool refused = false;
  std::shared_ptr<Session> session;
  {
    std::lock_guard lock(core->mutex);
    if (core->stopping) return;
    const size_t open = core->sessions.size(), allowed = size_t(core->settings.max_connections);
    refused = open >= allowed;
    core->refused += refused;
    if (open >= allowed + max_refusals) return;
    const std::string peer = remote.address().to_string() + ":" + std::to_string(remote.port());
    session = std::make_shared<Session>(core, std::move(socket), id, peer);
    core->sessions[id] = session;
  }
  session->start(refused);
}

void Server::Impl::stop_sessions(bool politely) {
  std::lock_guard lock(core->mutex);
  core->stopping = true;
  for (const auto& [id, weak] : core->sessions)
    if (auto session = weak.lock()) session->stop(politely);
}

template <class Duration>
bool Server::Impl::wait_until_empty(Duration limit) {
  std::unique_lock lock(core->mutex);
  return core->session_ended.wait_for(lock, limit, [this] { return core->sessions.empty(); });
}

void Server::Impl::stop() {
  std::call_once(stopped, [this] {
    net::post(acceptor.get_executor(), [this] {
      error_code ec;
      acceptor.close(ec);
    });
    stop_sessions(true);
    core->workers.stop();
    core->slow_workers.stop();
    if (!wait_until_empty(polite_stop)) stop_sessions(false);
    if (!wait_until_empty(forced_stop)) {
      log::error("connections do not end; they are left behind");
      core->io.stop();
    }
    work.reset();
    for (auto& thread : threads) thread.join();
  });
}

Server::Server(const StreamSettings& settings, Doors doors)
    : impl_(std::make_unique<Impl>(settings, std::move(doors))) {
  impl_->listen();
  net::co_spawn(
      impl_->acceptor.get_executor(), [impl = impl_.get()] { return impl->accept(); },
      [](std::exception_ptr error) {
        try {
          if (error) std::rethrow_exception(error);
        } catch (const std::exception& e) {
          log::error("accept: {}", e.what());
        }
      });
  for (int i = 0; i < std::max(1, settings.threads); i++)
    impl_->threads.emplace_back([core = impl_->core] {
      for (;;) {
        try {
          core->io.run();
          return;
        } catch (const std::exception& e) {
          log::error("input and output: {}", e.what());
        }
      }
    });
}

Server::~Server() { stop(); }

uint16_t Server::port() const { return impl_->port; }

void Server::stop() { impl_->stop(); }

StreamCounters Server::counters() const {
  Core& core = *impl_->core;
  StreamCounters counters;
  counters.accepted = core.accepted;
  counters.refused = core.refused;
  counters.http_requests = core.http_requests;
  counters.websockets = core.websockets;
  counters.slow_closed = core.slow_closed;
  counters.flood_closed = core.flood_closed;
  counters.accept_errors = core.accept_errors;
  std::lock_guard lock(core.mutex);
  counters.open = core.sessions.size();
  return counters;
}

}  // namespace wellspring
