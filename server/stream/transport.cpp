// SPDX-License-Identifier: Apache-2.0
#include "stream/transport.h"

#include <boost/asio/ssl/stream.hpp>
#include <optional>

namespace wellspring::stream {

static constexpr size_t record_bytes = 16 * 1024;  // most bytes of a TLS record

struct Transport::State {
  using Tls = net::ssl::stream<beast::tcp_stream&>;
  beast::tcp_stream tcp;
  std::shared_ptr<Certificate::Context> context;
  std::unique_ptr<Tls> tls;
  Watch watch;
  bool held = false;                     // the watch stopped reading
  std::optional<Completion> never_read;  // read that waits while `held`
  std::vector<char> record;              // TLS: bytes being written, small buffers put together

  explicit State(tcp::socket socket) : tcp(std::move(socket)) {}
};

Transport::Transport(tcp::socket socket) : state_(std::make_shared<State>(std::move(socket))) {}
Transport::~Transport() { state_->watch = nullptr; }

Transport::executor_type Transport::get_executor() noexcept { return state_->tcp.get_executor(); }
tcp::socket& Transport::socket() { return state_->tcp.socket(); }
void Transport::expires_after(double s) { state_->tcp.expires_after(seconds(s)); }
void Transport::expires_never() { state_->tcp.expires_never(); }
void Transport::watch(Watch watch) { state_->watch = std::move(watch); }
bool Transport::secure() const { return state_->tls != nullptr; }

void Transport::close() {
  state_->tcp.close();
  if (!state_->never_read) return;
  net::post(get_executor(), [done = std::move(*state_->never_read)]() mutable {
    done(net::error::operation_aborted, 0);
  });
  state_->never_read.reset();
}

void Transport::cut() {
  error_code ec;
  socket().set_option(net::socket_base::linger(true, 0), ec);
  close();
}

// Shows the watch the bytes that were read into `buffers`. False: it wants no more.
static bool show(const Transport::Watch& watch, const SomeBuffers<net::mutable_buffer>& buffers,
                 size_t bytes) {
  bool more = true;
  for (const net::mutable_buffer& buffer : buffers) {
    const size_t part = std::min(bytes, buffer.size());
    if (part > 0) more = watch({static_cast<const uint8_t*>(buffer.data()), part}) && more;
    bytes -= part;
  }
  return more;
}

void Transport::read(const SomeBuffers<net::mutable_buffer>& buffers, Completion done) {
  State& state = *state_;
  if (state.held) {
    state.never_read.emplace(std::move(done));
    return;
  }
  auto handler = [kept = state_, buffers, done = std::move(done)](error_code ec,
                                                                  size_t bytes) mutable {
    if (kept->watch && bytes > 0 && !show(kept->watch, buffers, bytes)) kept->held = true;
    done(ec, bytes);
  };
  if (state.tls) state.tls->async_read_some(buffers, std::move(handler));
  else state.tcp.async_read_some(buffers, std::move(handler));
}

void Transport::write(const SomeBuffers<net::const_buffer>& buffers, Completion done) {
  State& state = *state_;
  auto handler = [kept = state_, done = std::move(done)](error_code ec, size_t bytes) mutable {
    done(ec, bytes);
  };
  if (!state.tls) {
    state.tcp.async_write_some(buffers, std::move(handler));
    return;
  }
  // OpenSSL takes one buffer at a time: a small one, such as a frame's header, goes with the next.
  net::const_buffer whole = buffers.count > 0 ? buffers.list[0] : net::const_buffer();
  if (buffers.count > 1 && whole.size() < record_bytes) {
    state.record.resize(std::min(net::buffer_size(buffers), record_bytes));
    net::buffer_copy(net::buffer(state.record), buffers);
    whole = net::buffer(state.record);
  }
  state.tls->async_write_some(whole, std::move(handler));
}

net::awaitable<error_code> Transport::shake_hands(std::shared_ptr<Certificate::Context> context,
                                                  beast::flat_buffer& read_already) {
  const auto state = state_;
  state->context = std::move(context);
  auto tls = std::make_unique<State::Tls>(state->tcp, *state->context);
  error_code ec;
  const size_t used =
      co_await tls->async_handshake(net::ssl::stream_base::server, read_already.data(),
                                    net::redirect_error(net::use_awaitable, ec));
  read_already.consume(used);
  if (!ec) state->tls = std::move(tls);
  co_return ec;
}

// Says that nothing more will be written, and reads until the peer says so, too.
static net::awaitable<void> end_stream(beast::tcp_stream& tcp,
                                       net::ssl::stream<beast::tcp_stream&>* tls) {
  error_code ec;
  if (tls) co_await tls->async_shutdown(net::redirect_error(net::use_awaitable, ec));
  tcp.socket().shutdown(tcp::socket::shutdown_send, ec);
  std::array<char, 4096> thrown_away;
  for (size_t total = 0; !ec && total < 256 * 1024;)
    total += co_await tcp.async_read_some(net::buffer(thrown_away),
                                          net::redirect_error(net::use_awaitable, ec));
}

net::awaitable<void> Transport::linger(double most_seconds) {
  const auto state = state_;
  expires_after(most_seconds);
  co_await end_stream(state->tcp, state->tls.get());
  state->tcp.close();
}

void Transport::tear_down(Completion done) {
  net::co_spawn(
      get_executor(), [state = state_] { return end_stream(state->tcp, state->tls.get()); },
      [state = state_, done = std::move(done)](std::exception_ptr) mutable { done({}, 0); });
}

}  // namespace wellspring::stream
