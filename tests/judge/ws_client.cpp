// SPDX-License-Identifier: Apache-2.0
#include "judge/ws_client.h"

#include <optional>
#include <stdexcept>

#include "stream/asio.h"

namespace wellspring::test {

static constexpr size_t max_answer_bytes = 64 << 20;  // one message from the server

// Does the work of WsClient: every call starts an operation and runs the io_context until that one
// is done or its time is over. A read that is still waiting then goes on in the next call.
struct WsClient::Impl {
  net::io_context io{1};
  websocket::stream<beast::tcp_stream, false> ws{io};
  beast::flat_buffer buffer;
  std::string subprotocol;
  bool open = false;
  bool reading = false;
  std::optional<error_code> read_result;

  // Runs until `done` holds; false: the time was over first.
  template <class Done>
  bool run(double timeout, const Done& done) {
    const auto end = std::chrono::steady_clock::now() + seconds(timeout);
    io.restart();
    for (;;) {
      while (!done() && io.poll_one() > 0) {}
      if (done()) return true;
      if (std::chrono::steady_clock::now() >= end) return false;
      io.restart();
      io.run_one_until(end);
    }
  }

  // Runs `start(handler)` to its end; after `timeout` the connection is dropped.
  template <class Start>
  error_code finish(double timeout, const Start& start) {
    const auto result = std::make_shared<std::optional<error_code>>();
    start([result](error_code ec) { *result = ec; });
    if (run(timeout, [&] { return result->has_value(); })) return **result;
    drop();
    run(1, [&] { return result->has_value(); });  // the operation releases what it borrowed
    return beast::error::timeout;
  }

  void drop() {
    open = false;
    beast::get_lowest_layer(ws).close();
  }

  void shake_hands(const WsTarget& target, double timeout);
};

WsClient::WsClient() : impl_(std::make_unique<Impl>()) {}
WsClient::~WsClient() = default;
WsClient::WsClient(WsClient&&) noexcept = default;
WsClient& WsClient::operator=(WsClient&&) noexcept = default;

void WsClient::Impl::shake_hands(const WsTarget& target, double timeout) {
  const std::string port = std::to_string(target.port);
  const auto check = [&](const error_code& ec, const std::string& what) {
    if (ec)
      throw std::runtime_error("ws://" + target.host + ":" + port + target.path + ": " + what +
                               ": " + ec.message());
  };
  error_code ec;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(target.host, port, ec);
  check(ec, "resolve");
  auto& tcp_stream = beast::get_lowest_layer(ws);
  ec = finish(timeout, [&](auto handler) {
    tcp_stream.async_connect(found,
                             [handler](error_code ec, const tcp::endpoint&) { handler(ec); });
  });
  check(ec, "connect");
  tcp_stream.socket().set_option(tcp::no_delay(true), ec);
  ws.read_message_max(max_answer_bytes);
  ws.auto_fragment(false);
  ws.set_option(websocket::stream_base::decorator([&target](websocket::request_type& request) {
    if (!target.subprotocol.empty())
      request.set(http::field::sec_websocket_protocol, target.subprotocol);
    if (!target.origin.empty()) request.set(http::field::origin, target.origin);
  }));
  websocket::response_type response;
  const bool v6 = target.host.find(':') != std::string::npos;
  const std::string host = (v6 ? "[" + target.host + "]" : target.host) + ":" + port;
  ec = finish(timeout,
              [&](auto handler) { ws.async_handshake(response, host, target.path, handler); });
  if (ec == websocket::error::upgrade_declined)
    check(ec, "HTTP status " + std::to_string(response.result_int()));
  check(ec, "handshake");
  const auto chosen = response[http::field::sec_websocket_protocol];
  subprotocol.assign(chosen.data(), chosen.size());
  open = true;
}

void WsClient::connect(const WsTarget& target, double timeout) {
  impl_ = std::make_unique<Impl>();
  impl_->shake_hands(target, timeout);
}

bool WsClient::send_text(std::string_view text, double timeout) {
  Impl& impl = *impl_;
  if (!impl.open) return false;
  impl.ws.text(true);
  const error_code ec = impl.finish(timeout, [&](auto handler) {
    impl.ws.async_write(net::buffer(text.data(), text.size()),
                        [handler](error_code ec, size_t) { handler(ec); });
  });
  if (ec) impl.drop();
  return !ec;
}

WsClient::Got WsClient::receive(WsMessage& message, double timeout) {
  Impl& impl = *impl_;
  if (!impl.open && !impl.reading) return Got::closed;
  if (!impl.reading) {
    impl.reading = true;
    impl.read_result.reset();
    impl.ws.async_read(impl.buffer, [&impl](error_code ec, size_t) { impl.read_result = ec; });
  }
  if (!impl.run(timeout, [&] { return impl.read_result.has_value(); })) return Got::nothing;
  impl.reading = false;
  if (*impl.read_result) {
    impl.drop();
    return Got::closed;
  }
  const auto data = impl.buffer.data();
  const auto* begin = static_cast<const uint8_t*>(data.data());
  message.binary = impl.ws.got_binary();
  message.bytes.assign(begin, begin + data.size());
  impl.buffer.consume(impl.buffer.size());
  return Got::message;
}

void WsClient::close(double timeout) {
  Impl& impl = *impl_;
  if (!impl.open) return;
  impl.finish(timeout,
              [&](auto handler) { impl.ws.async_close(websocket::close_code::normal, handler); });
  impl.drop();
}

bool WsClient::connected() const { return impl_->open; }
std::string WsClient::subprotocol() const { return impl_->subprotocol; }
int WsClient::close_code() const { return int(impl_->ws.reason().code); }
std::string WsClient::close_reason() const {
  const auto& reason = impl_->ws.reason().reason;
  return {reason.data(), reason.size()};
}

}  // namespace wellspring::test
