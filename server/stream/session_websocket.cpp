// SPDX-License-Identifier: Apache-2.0
// Runs the WebSocket half of a session, with two coroutines on one strand: the session's own reads,
// a second one writes, one message at a time, and is the only one that starts a close.
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>

#include "base/clock.h"
#include "base/log.h"
#include "stream/reply.h"
#include "stream/session.h"
#include "wire/json.h"

namespace wellspring::stream {

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
  stream().expires_never();  // from here on the WebSocket has its own timeouts
  set_socket_options(stream().socket());
  websocket::stream_base::timeout timeout;
  timeout.handshake_timeout = seconds(settings.write_timeout);
  timeout.idle_timeout = seconds(settings.idle_timeout);
  timeout.keep_alive_pings = true;
  ws_.set_option(timeout);
  ws_.read_message_max(max_message_bytes);
  ws_.auto_fragment(false);  // a picture is one frame, sent without a copy
  const bool echo = upgrade_->count(http::field::sec_websocket_protocol) > 0;
  const bool secure = stream().secure();
  ws_.set_option(websocket::stream_base::decorator([=](websocket::response_type& response) {
    response.set(http::field::server, "wellspring");
    for (const auto& [name, value] : security_headers(secure)) response.set(name, value);
    if (echo) response.set(http::field::sec_websocket_protocol, "wellspring.v1");
  }));
  ws_.control_callback([this](websocket::frame_type type, beast::string_view payload) {
    if (type == websocket::frame_type::pong && take_pong(payload)) return;
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
  const bool local = is_local(*upgrade_);
  upgrade_.reset();
  link_ = std::make_shared<Link>(core_->next_link++, eye ? LinkKind::eye : LinkKind::visit,
                                 caller_.name);
  if (!caller_.trusted) link_->address = to_string(limited_part(caller_.address));
  link_->local = local;
  link_->kiosk = admitted_.kiosk;
  link_->set_wake([weak = weak_from_this()] {
    if (auto self = weak.lock()) self->wake_writer();
  });
  core_->websockets++;
  net::co_spawn(
      ws_.get_executor(), [self = shared_from_this()] { return self->write_messages(); },
      [self = shared_from_this()](std::exception_ptr error) {
        if (error) {
          log::error("session {}: writer failed", self->name_);
          self->cut("writer failed");
        }
        self->writer_ended_.raise();
      });
  stream().watch([this](std::span<const uint8_t> bytes) {
    return count_input({double(frame_counter_.count(bytes)), double(bytes.size())});
  });
  core_->admission.begin_waiting(id_);
  start_first_deadline();
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
  first_deadline_.cancel();
  flood_deadline_.cancel();
  core_->websockets--;
  if (!joined_) co_return;
  log::info("{} {} left, {} pictures, {} bytes sent", eye ? "eye" : "visit", link_->id,
            link_->pictures_sent.load(), link_->bytes_sent.load());
}

// Reads a text that came. With its first one the peer joins: a peer that sends nothing takes no
// place among visitors.
void Session::hear(std::string text) {
  const size_t values = link_->push_text_in(std::move(text));
  if (!count_input({0, value_bytes * double(values)}) || joined_) return;
  joined_ = true;
  core_->admission.end_waiting(id_);
  log::info("{} {} joined from {}", link_->kind == LinkKind::eye ? "eye" : "visit", link_->id,
            caller_.name);
  try {
    if (core_->doors.joined) core_->doors.joined(link_);
  } catch (const std::exception& e) {
    log::error("joined: {}", e.what());
    want_close(websocket::close_code::internal_error, "internal error");
  }
}

void Session::start_first_deadline() {
  first_deadline_.expires_after(seconds(core_->settings.first_message_timeout));
  first_deadline_.async_wait([self = shared_from_this()](error_code ec) {
    if (ec || self->joined_) return;
    self->core_->silent_closed++;
    self->want_close(websocket::close_code::policy_error, "no first message came");
  });
}

// Reads until the connection ends (false) or is to be closed (true; the writer's async_close then
// reads and throws away what still comes). No read may be started once a close was: if the peer's
// close frame has already been received and there is a control callback, such a read keeps Beast's
// read lock while it waits for the write lock, and the close the other way round, for ever (Boost
// 1.74 and 1.81).
net::awaitable<bool> Session::read_messages() {
  beast::flat_buffer buffer;
  while (close_reason_.code == websocket::close_code::none) {
    error_code ec;
    co_await ws_.async_read(buffer, net::redirect_error(net::use_awaitable, ec));
    if (ec) {
      fail(ec, "WebSocket read");
      co_return false;
    }
    if (!ws_.got_text()) want_close(websocket::close_code::unknown_data, "text messages only");
    else if (close_reason_.code == websocket::close_code::none)
      hear(beast::buffers_to_string(buffer.data()));
    buffer.consume(buffer.size());
  }
  co_return true;
}

// Counts input as it comes. False: it is more than a peer may send, the connection is being closed,
// and nothing more is read: the peer has a moment to read why.
bool Session::count_input(const WireInput& input) {
  if (flooded_) return false;
  const double now = seconds_now();
  const bool own = frames_.take(input.frames, now) && bytes_.take(input.bytes, now);
  const bool few = modest_.take(input.frames, now), small = modest_bytes_.take(input.bytes, now);
  const bool modest = few && small;
  using Taken = Admission::Taken;
  const Taken shared = !own || caller_.trusted
                           ? Taken::yes
                           : core_->admission.take_input(caller_.address, input, modest, now);
  if (own && shared == Taken::yes) return true;
  flooded_ = true;
  core_->flood_closed++;
  log::warn("session {}: too many messages{}, closed", caller_.name,
            !own                        ? ""
            : shared == Taken::too_many ? " from its address"
                                        : " from all addresses together, this one among the most");
  want_close(websocket::close_code::policy_error, "too many messages");
  flood_deadline_.expires_after(seconds(flood_linger));
  flood_deadline_.async_wait([self = shared_from_this()](error_code ec) {
    if (!ec) self->cut("too many messages");
  });
  return false;
}

void Session::want_close(websocket::close_code code, std::string reason) {
  if (close_reason_.code != websocket::close_code::none) return;
  close_reason_.code = code;
  reason.resize(std::min(reason.size(), size_t(120)));  // a control frame holds 125 bytes
  close_reason_.reason = websocket::reason_string(reason.data(), reason.size());
  link_->mark_closed();  // nothing more is sent or read
  writable_.raise();
}

void Session::wake_writer() {
  if (wake_posted_.exchange(true)) return;
  net::post(ws_.get_executor(), [self = shared_from_this()] {
    self->wake_posted_ = false;
    self->writable_.raise();
  });
}

// Starts a timer for one write. Beast bounds silence, not a write that is pending: a peer that
// reads nothing but pings now and then would hold its picture for ever. The timer runs only while
// something is being written.
void Session::start_deadline() {
  deadline_.expires_after(seconds(core_->settings.write_timeout));
  deadline_.async_wait([self = shared_from_this(), number = ++deadline_number_](error_code ec) {
    if (ec || number != self->deadline_number_) return;
    self->core_->slow_closed++;
    log::warn("session {}: reads too slowly, closed", self->name_);
    self->cut("a write was pending too long");
  });
}

void Session::end_deadline() {
  deadline_number_++;
  deadline_.cancel();
}

net::awaitable<error_code> Session::ping(Delivery behind) {
  error_code ec;
  const std::string number = std::to_string(first_ping_ + pinged_.size());
  pinged_.push_back(behind);
  ping_at_ = seconds_now();
  start_deadline();
  co_await ws_.async_ping(websocket::ping_data(number.data(), number.size()),
                          net::redirect_error(net::use_awaitable, ec));
  end_deadline();
  co_return ec;
}

// Returns whether it answers a ping of ours; data before earlier pings has arrived then, too.
bool Session::take_pong(beast::string_view payload) {
  const std::string number(payload);
  size_t answered = 0;
  while (answered < pinged_.size() && std::to_string(first_ping_ + answered) != number) answered++;
  if (answered == pinged_.size()) return false;
  pinged_[answered].ended = seconds_now();
  if (link_) link_->push_delivery(pinged_[answered]);
  pinged_.erase(pinged_.begin(), pinged_.begin() + ptrdiff_t(answered) + 1);
  first_ping_ += answered + 1;
  return true;
}

net::awaitable<void> Session::write_messages() {
  if (link_->kind == LinkKind::visit) co_await ping({0, seconds_now(), 0, true, false});
  while (!ended_ && close_reason_.code == websocket::close_code::none) {
    // This is asked before the queue: messages that were sent before the close are still written.
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
    Delivery written{bytes.size(), seconds_now(), 0, pinged_.empty(), out.picture};
    start_deadline();
    co_await ws_.async_write(bytes, net::redirect_error(net::use_awaitable, ec));
    end_deadline();
    const bool asks =
        out.picture || written.bytes >= pinged_bytes || written.began - ping_at_ >= ping_interval;
    if (!ec && asks && link_->kind == LinkKind::visit && pinged_.size() < most_pings)
      ec = co_await ping(written);
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

}  // namespace wellspring::stream
