// SPDX-License-Identifier: Apache-2.0
// The WebSocket half of a session. Two coroutines on one strand: the session's own reads, a second
// one writes, one message at a time, and is the only one that starts a close.
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>

#include "base/clock.h"
#include "base/log.h"
#include "stream/reply.h"
#include "stream/session.h"
#include "wire/json.h"

namespace wellspring {

static void set_socket_options(tcp::socket& socket) {
  error_code ec;
  socket.set_option(net::socket_base::send_buffer_size(send_buffer_bytes), ec);
  if (ec) fail(ec, "send buffer");
#ifdef TCP_NOTSENT_LOWAT
  const int bytes = unsent_bytes, fd = socket.native_handle();
  if (setsockopt(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &bytes, sizeof(bytes)) != 0)
    fail(error_code(errno, net::error::get_system_category()), "unsent bytes");
#endif
}

net::awaitable<bool> Session::accept_websocket() {
  const StreamSettings& settings = core_->settings;
  stream().expires_never();  // from here the WebSocket has its own clocks
  set_socket_options(stream().socket());
  websocket::stream_base::timeout timeout;
  timeout.handshake_timeout = seconds(settings.write_timeout);
  timeout.idle_timeout = seconds(settings.idle_timeout);
  timeout.keep_alive_pings = true;
  ws_.set_option(timeout);
  ws_.read_message_max(max_message_bytes);
  ws_.auto_fragment(false);  // a picture is one frame, written from where it lies
  const bool echo = upgrade_->count(http::field::sec_websocket_protocol) > 0;
  ws_.set_option(websocket::stream_base::decorator([echo](websocket::response_type& response) {
    response.set(http::field::server, "wellspring");
    for (const auto& [name, value] : security_headers()) response.set(name, value);
    if (echo) response.set(http::field::sec_websocket_protocol, "wellspring.v1");
  }));
  ws_.control_callback([this](websocket::frame_type type, beast::string_view) {
    count_input(1, 0);
    // The visit is over, though the peer may take its time to close the socket.
    if (type == websocket::frame_type::close && link_) link_->mark_closed();
  });
  error_code ec;
  co_await ws_.async_accept(*upgrade_, net::redirect_error(net::use_awaitable, ec));
  if (ec) fail(ec, "WebSocket handshake");
  co_return !ec;
}

net::awaitable<void> Session::serve_websocket() {
  const bool accepted = co_await accept_websocket();
  if (!accepted) co_return;
  const beast::string_view target = upgrade_->target();
  const bool eye = target.substr(0, target.find('?')).ends_with("/eye");
  upgrade_.reset();
  link_ = std::make_shared<Link>(core_->next_link++, eye ? LinkKind::eye : LinkKind::visit, peer_);
  link_->set_wake([weak = weak_from_this()] {
    if (auto self = weak.lock()) self->wake_writer();
  });
  core_->websockets++;
  log::info("{} {} joined from {}", eye ? "eye" : "visit", link_->id, peer_);
  net::co_spawn(
      ws_.get_executor(), [self = shared_from_this()] { return self->write_messages(); },
      [self = shared_from_this()](std::exception_ptr error) {
        if (error) {
          log::error("session {}: writer failed", self->peer_);
          self->cut("writer failed");
        }
        self->writer_ended_.raise();
      });
  try {
    if (core_->doors.joined) core_->doors.joined(link_);
  } catch (const std::exception& e) {
    log::error("joined: {}", e.what());
    want_close(websocket::close_code::internal_error, "internal error");
  }
  if (stopping_) want_close(websocket::close_code::going_away, "server stops");
  const bool connected = co_await read_messages();
  if (!connected) {
    ended_ = true;
    link_->mark_closed();
    stream().close();
    writable_.raise();
  }
  co_await writer_ended_.wait();
  end_deadline();
  core_->websockets--;
  log::info("{} {} left, {} pictures, {} bytes sent", eye ? "eye" : "visit", link_->id,
            link_->pictures_sent.load(), link_->bytes_sent.load());
}

// Until the connection ends (false) or is to be closed (true; the writer's async_close then reads
// and throws away what still comes). No read may be started once a close was: where the peer's
// close frame has already been received and there is a control callback, such a read keeps Beast's
// read lock while it waits for the write lock, and the close the other way round, for ever
// (Boost 1.74 and 1.81).
net::awaitable<bool> Session::read_messages() {
  beast::flat_buffer buffer;
  while (close_reason_.code == websocket::close_code::none) {
    error_code ec;
    const size_t bytes =
        co_await ws_.async_read(buffer, net::redirect_error(net::use_awaitable, ec));
    if (ec) {
      fail(ec, "WebSocket read");
      co_return false;
    }
    const bool counted = count_input(1, double(bytes));
    if (counted && !ws_.got_text())
      want_close(websocket::close_code::unknown_data, "text messages only");
    else if (counted) link_->push_text_in(beast::buffers_to_string(buffer.data()));
    buffer.consume(buffer.size());
  }
  co_return true;
}

// False: more than a peer may say, the connection is being closed.
bool Session::count_input(double messages, double bytes) {
  if (close_reason_.code != websocket::close_code::none) return false;
  const double now = seconds_now();
  if (messages_.take(messages, now) && bytes_.take(bytes, now)) return true;
  core_->flood_closed++;
  log::warn("session {}: too many messages, closed", peer_);
  want_close(websocket::close_code::policy_error, "too many messages");
  return false;
}

void Session::want_close(websocket::close_code code, std::string reason) {
  if (close_reason_.code != websocket::close_code::none) return;
  close_reason_.code = code;
  reason.resize(std::min(reason.size(), size_t(120)));  // a control frame holds 125 bytes
  close_reason_.reason = websocket::reason_string(reason.data(), reason.size());
  link_->mark_closed();  // nothing more goes either way
  writable_.raise();
}

void Session::wake_writer() {
  if (wake_posted_.exchange(true)) return;
  net::post(ws_.get_executor(), [self = shared_from_this()] {
    self->wake_posted_ = false;
    self->writable_.raise();
  });
}

// Beast bounds silence, not a write that is pending: a peer that reads nothing but pings now and
// then would hold its picture for ever. This clock runs only while something is being written.
void Session::start_deadline() {
  deadline_.expires_after(seconds(core_->settings.write_timeout));
  deadline_.async_wait([self = shared_from_this(), number = ++deadline_number_](error_code ec) {
    if (ec || number != self->deadline_number_) return;
    self->core_->slow_closed++;
    log::warn("session {}: reads too slowly, closed", self->peer_);
    self->cut("a write was pending too long");
  });
}

void Session::end_deadline() {
  deadline_number_++;
  deadline_.cancel();
}

net::awaitable<void> Session::write_messages() {
  while (!ended_ && close_reason_.code == websocket::close_code::none) {
    // Asked before the queue: what was sent before the close is still written.
    std::string reason;
    const bool closing = link_->close_requested(reason);
    Link::Out out;
    if (!link_->take_out(out)) {
      if (closing) want_close(websocket::close_code::normal, reason);
      else co_await writable_.wait();
      continue;
    }
    ws_.binary(out.binary);
    const auto bytes = out.binary ? net::buffer(*out.packet) : net::buffer(std::as_const(out.text));
    error_code ec;
    start_deadline();
    co_await ws_.async_write(bytes, net::redirect_error(net::use_awaitable, ec));
    end_deadline();
    if (ec) {
      fail(ec, "WebSocket write");
      stream().close();
      co_return;
    }
    link_->bytes_sent += bytes.size();
    link_->pictures_sent += out.picture;
  }
  if (ended_) co_return;
  error_code ec;
  start_deadline();
  co_await ws_.async_close(close_reason_, net::redirect_error(net::use_awaitable, ec));
  end_deadline();
  if (ec) fail(ec, "WebSocket close");
  stream().close();
}

}  // namespace wellspring
