// SPDX-License-Identifier: Apache-2.0
// Listens, accepts, and ends everything in order.
#include "stream/server.h"

#include <stdexcept>
#include <sys/resource.h>
#include <thread>

#include "base/clock.h"
#include "base/log.h"
#include "stream/session.h"
#include "wire/prometheus.h"

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
    // A new connection's buffer takes these few bytes at once, so no caller keeps the next one
    // waiting.
    socket.non_blocking(true, ec);
    socket.write_some(net::buffer(line), ec);
    socket.shutdown(tcp::socket::shutdown_send, ec);
  }
}

// Most connections that are sent a refusal at a time; more are just closed.
static constexpr int max_refusals = 64;
static constexpr rlim_t other_descriptors = 512;  // files, pipes, and connections being refused
static constexpr auto accept_pause = std::chrono::milliseconds(100);
static constexpr auto polite_stop = std::chrono::seconds(1);
static constexpr auto forced_stop = std::chrono::seconds(5);

struct Server::Impl {
  std::shared_ptr<Core> core;
  net::executor_work_guard<net::io_context::executor_type> work;
  tcp::acceptor acceptor, agent_acceptor;  // on one strand
  net::steady_timer certificate_pause;
  uint16_t port = 0;
  std::vector<std::thread> threads;
  std::once_flag stopped;

  Impl(const StreamSettings& settings, Doors doors)
      : core(std::make_shared<Core>(settings, std::move(doors))),
        work(core->io.get_executor()),
        acceptor(net::make_strand(core->io)),
        agent_acceptor(acceptor.get_executor()),
        certificate_pause(acceptor.get_executor()) {}

  void listen();
  net::awaitable<void> accept();
  void admit(tcp::socket socket, uint64_t id);
  void drop(uint64_t id);
  void forget(uint64_t id);
  net::awaitable<void> watch_certificate();
  net::awaitable<void> tell_agents();
  void spawn(net::awaitable<void> (Impl::*work)());
  void stop();
  template <class Duration>
  bool wait_until_empty(Duration limit);
  void stop_sessions(bool politely);
};

void Server::Impl::listen() {
  const StreamSettings& settings = core->settings;
  listen_on(core->io, settings.host, settings.port, acceptor);
  port = acceptor.local_endpoint().port();
  if (settings.agent_port != 0)
    listen_on(core->io, settings.host, settings.agent_port, agent_acceptor);
}

// Accepts connections, and never ends on an error: a server that lives on without accepting looks
// healthy and is not.
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
    if (ec == net::error::connection_aborted) continue;  // the peer has gone again
    core->accept_errors++;
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
  const auto session = std::make_shared<Session>(core, std::move(socket), id, remote);
  {
    std::lock_guard lock(core->mutex);
    if (core->stopping) return;
    core->sessions[id] = session;
  }
  const Admission::Entry entry =
      core->admission.enter(id, session->address(), session->standing(), seconds_now());
  if (entry.drop) drop(*entry.drop);
  if (entry.reserved) session->set_reserved();
  if (entry.answer == Admission::Answer::welcome) {
    session->start();
    return;
  }
  core->refused++;
  if (core->being_refused < max_refusals)
    session->start_refusal(entry.answer == Admission::Answer::full ? 503 : 429);
  else forget(id);
}

void Server::Impl::drop(uint64_t id) {
  std::lock_guard lock(core->mutex);
  const auto found = core->sessions.find(id);
  const auto session = found == core->sessions.end() ? nullptr : found->second.lock();
  if (session) session->drop();
}

void Server::Impl::forget(uint64_t id) {
  std::lock_guard lock(core->mutex);
  core->sessions.erase(id);
  core->session_ended.notify_all();
}

// Looks for changes of the certificate's files, which may come while the server runs.
net::awaitable<void> Server::Impl::watch_certificate() {
  while (core->certificate && acceptor.is_open()) {
    error_code ec;
    certificate_pause.expires_after(seconds(core->settings.certificate_interval));
    co_await certificate_pause.async_wait(net::redirect_error(net::use_awaitable, ec));
    if (!ec) core->certificate->look_again();
  }
}

net::awaitable<void> Server::Impl::tell_agents() {
  if (core->doors.agent) co_await tell_callers(agent_acceptor, core->doors.agent);
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
      agent_acceptor.close(ec);
      certificate_pause.cancel();
    });
    stop_sessions(true);
    core->workers.stop();
    core->slow_workers.stop();
    core->health_workers.stop();
    if (!wait_until_empty(polite_stop)) stop_sessions(false);
    if (!wait_until_empty(forced_stop)) {
      log::error("connections do not end; they are left behind");
      core->io.stop();
    }
    work.reset();
    for (auto& thread : threads) thread.join();
  });
}

void Server::Impl::spawn(net::awaitable<void> (Impl::*work)()) {
  net::co_spawn(
      acceptor.get_executor(), [this, work] { return (this->*work)(); },
      [](std::exception_ptr error) {
        try {
          if (error) std::rethrow_exception(error);
        } catch (const std::exception& e) {
          log::error("accept: {}", e.what());
        }
      });
}

// Asks the kernel for as many descriptors as connections need, and makes do with fewer connections
// if it allows fewer.
static StreamSettings fit_to_descriptors(StreamSettings settings) {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0) return settings;
  const rlim_t wanted = rlim_t(settings.limits.connections) + other_descriptors;
  if (files.rlim_cur < wanted) {
    files.rlim_cur = std::min(wanted, files.rlim_max);
    setrlimit(RLIMIT_NOFILE, &files);
    getrlimit(RLIMIT_NOFILE, &files);
  }
  if (files.rlim_cur >= wanted) return settings;
  const rlim_t left = files.rlim_cur - std::min(files.rlim_cur / 2, other_descriptors);
  settings.limits.connections = int(left);
  log::warn("only {} connections at a time: the limit of open files is {} (ulimit -n)", left,
            files.rlim_cur);
  return settings;
}

Server::Server(const StreamSettings& settings, Doors doors)
    : impl_(std::make_unique<Impl>(fit_to_descriptors(settings), std::move(doors))) {
  impl_->listen();
  impl_->spawn(&Impl::accept);
  impl_->spawn(&Impl::watch_certificate);
  impl_->spawn(&Impl::tell_agents);
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

void Server::reread_certificate() {
  if (impl_->core->certificate)
    net::post(impl_->acceptor.get_executor(),
              [core = impl_->core] { core->certificate->read_again(); });
}

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
  counters.limited = core.limited;
  counters.limited_in_all = core.limited_in_all;
  counters.dropped = core.dropped;
  counters.silent_closed = core.silent_closed;
  counters.addresses = core.admission.addresses();
  std::lock_guard lock(core.mutex);
  counters.open = core.sessions.size();
  return counters;
}

std::string to_metrics(const StreamCounters& counters) {
  std::string text;
  add_metric(text, "connections_accepted_total", "Connections accepted", counters.accepted);
  add_metric(text, "connections_refused_total", "Connections told that there is no place",
             counters.refused);
  add_metric(text, "connections_dropped_total", "Connections that waited and made place",
             counters.dropped);
  add_metric(text, "connections", "Connections now", counters.open);
  add_metric(text, "accept_errors_total", "Connections that could not be accepted",
             counters.accept_errors);
  add_metric(text, "http_requests_total", "HTTP requests", counters.http_requests);
  add_metric(text, "address_limited_total", "Refused by the limits of their address",
             counters.limited);
  add_metric(text, "all_limited_total", "Refused by the limits of all addresses together",
             counters.limited_in_all);
  add_metric(text, "websockets_total", "WebSockets opened", counters.websockets);
  add_metric(text, "slow_readers_closed_total", "Closed since they did not read",
             counters.slow_closed);
  add_metric(text, "floods_closed_total", "Closed since they said too much", counters.flood_closed);
  add_metric(text, "silent_closed_total", "WebSockets closed that said nothing",
             counters.silent_closed);
  add_metric(text, "addresses", "Addresses that are remembered", counters.addresses);
  return text;
}

}  // namespace wellspring::stream
