// SPDX-License-Identifier: Apache-2.0
#include "stream/session.h"

#include "base/log.h"
#include "stream/reply.h"

namespace wellspring {

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

Session::Session(std::shared_ptr<Core> core, tcp::socket socket, uint64_t id, std::string peer)
    : core_(std::move(core)),
      id_(id),
      peer_(std::move(peer)),
      ws_(std::move(socket)),
      buffer_(max_header_bytes + max_body_bytes),
      answered_(ws_.get_executor()),
      writable_(ws_.get_executor()),
      writer_ended_(ws_.get_executor()),
      deadline_(ws_.get_executor()) {}

void Session::start(bool refused) {
  net::co_spawn(
      ws_.get_executor(), [self = shared_from_this(), refused] { return self->run(refused); },
      [self = shared_from_this()](std::exception_ptr error) {
        try {
          if (error) std::rethrow_exception(error);
        } catch (const std::exception& e) {
          log::error("session {}: {}", self->peer_, e.what());
        }
        error_code ec;
        self->stream().socket().close(ec);
        if (self->link_) self->link_->mark_closed();
        // Notified under the lock: the waiter may be the destructor of what the lock lives in.
        std::lock_guard lock(self->core_->mutex);
        self->core_->sessions.erase(self->id_);
        self->core_->session_ended.notify_all();
      });
}

net::awaitable<void> Session::run(bool refused) {
  if (refused) {
    HttpQuestion nothing_read;
    HttpReply reply = make_refusal(503, "too many connections");
    reply.headers["Retry-After"] = "5";
    co_await write_reply(std::move(nothing_read), std::move(reply), 11, false);
    co_await linger();
    co_return;
  }
  co_await serve_http();
  if (upgrade_) co_await serve_websocket();
}

void Session::stop(bool politely) {
  net::post(ws_.get_executor(), [self = shared_from_this(), politely] {
    self->stopping_ = true;
    if (!politely) self->cut("server stops");
    else if (self->link_) self->want_close(websocket::close_code::going_away, "server stops");
    else if (self->reading_) self->stream().close();
  });
}

// Resets the connection: what the kernel still holds for this peer is thrown away with it.
void Session::cut(const char* why) {
  log::debug("session {}: cut, {}", peer_, why);
  error_code ec;
  stream().socket().set_option(net::socket_base::linger(true, 0), ec);
  stream().close();
}

}  // namespace wellspring
