// SPDX-License-Identifier: Apache-2.0
#include "stream/session.h"

#include <stdexcept>
#include <utility>

#include "base/log.h"
#include "stream/reply.h"

namespace wellspring::stream {

void fail(const error_code& ec, const char* where) {
  const bool usual = ec == net::error::operation_aborted || ec == net::error::eof ||
                     ec == net::error::connection_reset || ec == net::error::broken_pipe ||
                     ec == beast::error::timeout || ec == websocket::error::closed ||
                     ec.category() == make_error_code(http::error::end_of_stream).category() ||
                     ec.category() == make_error_code(websocket::error::closed).category();
  if (usual) log::debug("{}: {}", where, ec.message());
  else log::warn("{}: {}", where, ec.message());
}

void Signal::raise() {
  raised_ = true;
  timer_.cancel();
}

net::awaitable<void> Signal::wait() {
  while (!raised_) {
    error_code ec;
    timer_.expires_at(net::steady_timer::time_point::max());
    co_await timer_.async_wait(net::redirect_error(net::use_awaitable, ec));
  }
  raised_ = false;
}

static std::vector<Network> read_networks(const std::vector<std::string>& texts) {
  std::vector<Network> networks;
  for (const std::string& text : texts) networks.push_back(read_network(text));
  return networks;
}

Core::Core(const StreamSettings& settings, Doors doors)
    : settings(settings),
      doors(std::move(doors)),
      hosts(settings.allowed_hosts, settings.allowed_origins, settings.host),
      trusted(read_networks(settings.trusted)),
      proxies(read_networks(settings.proxies)),
      admission(settings.limits) {
  if (settings.trust_loopback)
    for (const char* own : {"127.0.0.1", "::1"}) trusted.push_back(read_network(own));
  if (settings.certificate.empty() != settings.key.empty())
    throw std::runtime_error("TLS needs both a certificate and its key");
  if (!settings.certificate.empty())
    certificate = std::make_unique<Certificate>(settings.certificate, settings.key);
}

net::awaitable<bool> Signal::wait_for(std::chrono::milliseconds limit) {
  if (!raised_) {
    error_code ec;
    timer_.expires_after(limit);
    co_await timer_.async_wait(net::redirect_error(net::use_awaitable, ec));
  }
  co_return std::exchange(raised_, false);
}

Session::Session(std::shared_ptr<Core> core, tcp::socket socket, uint64_t id,
                 const tcp::endpoint& remote)
    : core_(std::move(core)),
      id_(id),
      peer_(remote.address().to_string() + ":" + std::to_string(remote.port())),
      address_(read_address(remote.address().to_string()).value_or(Address{})),
      name_(standing() == Standing::stranger ? shortened(address_) + " #" + std::to_string(id_)
                                             : peer_),
      ws_(std::move(socket)),
      buffer_(max_header_bytes + max_body_bytes),
      answered_(ws_.get_executor()),
      writable_(ws_.get_executor()),
      writer_ended_(ws_.get_executor()),
      deadline_(ws_.get_executor()),
      first_deadline_(ws_.get_executor()),
      flood_deadline_(ws_.get_executor()) {}

Session::~Session() { stream().watch(nullptr); }

Standing Session::standing() const {
  if (any_holds(core_->proxies, address_)) return Standing::proxy;
  return any_holds(core_->trusted, address_) ? Standing::trusted : Standing::stranger;
}

template <class Work>
void Session::spawn(Work work) {
  net::co_spawn(ws_.get_executor(), std::move(work),
                [self = shared_from_this()](std::exception_ptr error) {
                  try {
                    if (error) std::rethrow_exception(error);
                  } catch (const std::exception& e) {
                    log::error("session {}: {}", self->name_, e.what());
                  }
                  self->stream().close();
                  if (self->link_) self->link_->mark_closed();
                  if (self->counted_websocket_)
                    self->core_->admission.close_websocket(self->caller_.address);
                  self->core_->admission.leave(self->id_);
                  if (self->refused_) self->core_->being_refused--;
                  // This is notified under the lock: the waiter may be the destructor of the object
                  // that holds the lock.
                  std::lock_guard lock(self->core_->mutex);
                  self->core_->sessions.erase(self->id_);
                  self->core_->session_ended.notify_all();
                });
}

void Session::start() {
  spawn([self = shared_from_this()] { return self->run(); });
}

void Session::start_refusal(int status) {
  core_->being_refused++;
  refused_ = true;
  spawn([self = shared_from_this(), status] { return self->refuse(status); });
}

net::awaitable<void> Session::refuse(int status) {
  if (core_->certificate) co_return;  // no TLS handshake for a refusal
  HttpQuestion nothing_read;
  HttpReply reply = make_refusal(status, "too many connections");
  reply.headers["Retry-After"] = "5";
  co_await write_reply(std::move(nothing_read), std::move(reply), 11, false);
  co_await linger();
}

net::awaitable<void> Session::run() {
  if (core_->certificate) {
    const bool ready = co_await start_tls();
    if (!ready) co_return;
  }
  co_await serve_http();
  if (upgrade_) co_await serve_websocket();
}

// Starts TLS if the first bytes are a TLS handshake. False: the connection is over.
net::awaitable<bool> Session::start_tls() {
  static constexpr uint8_t handshake_record = 22;
  stream().expires_after(core_->settings.header_timeout);
  reading_ = true;
  error_code ec;
  const size_t bytes = co_await stream().async_read_some(
      buffer_.prepare(512), net::redirect_error(net::use_awaitable, ec));
  buffer_.commit(bytes);
  if (!ec && *static_cast<const uint8_t*>(buffer_.data().data()) == handshake_record)
    ec = co_await stream().shake_hands(core_->certificate->context(), buffer_);
  reading_ = false;
  if (ec) log::debug("session {}: TLS: {}", name_, ec.message());  // many scanners try this
  co_return !ec;
}

void Session::stop(bool politely) {
  net::post(ws_.get_executor(), [self = shared_from_this(), politely] {
    self->stopping_ = true;
    if (!politely) self->cut("server stops");
    else if (self->link_) self->want_close(websocket::close_code::going_away, "server stops");
    else if (self->reading_) self->stream().close();
  });
}

void Session::drop() {
  net::post(ws_.get_executor(), [self = shared_from_this()] {
    self->core_->dropped++;
    self->cut("made place for another");
  });
}

// Resets the connection: bytes that the kernel still holds for this peer are thrown away.
void Session::cut(const char* why) {
  log::debug("session {}: cut, {}", name_, why);
  stream().cut();
}

}  // namespace wellspring::stream
