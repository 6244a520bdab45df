// SPDX-License-Identifier: Apache-2.0
// Carries the byte stream of one connection, plain or TLS, as Beast's AsyncStream. Buffers and
// handlers have one type inside, so that neither TLS nor sockets are compiled once more for each
// operation of HTTP and WebSocket. All calls come from the strand of the socket. Only for the .cpp
// files of this folder (heavy).
#pragma once
#include <array>
#include <concepts>
#include <functional>
#include <memory>
#include <span>

#include "stream/asio.h"
#include "stream/certificate.h"

namespace wellspring::stream {

// Holds a handler of an operation, of any type. Called at most once, on the strand.
class Completion {
 public:
  template <class Handler>
  requires(!std::same_as<std::decay_t<Handler>, Completion>) explicit Completion(Handler&& handler)
      : held_(std::make_unique<Held<std::decay_t<Handler>>>(std::forward<Handler>(handler))) {}
  void operator()(error_code ec, size_t bytes) {
    std::exchange(held_, nullptr).release()->call(ec, bytes);
  }

 private:
  struct Any {
    virtual ~Any() = default;
    virtual void call(error_code ec, size_t bytes) = 0;  // destroys this object first
  };
  template <class Handler>
  struct Held : Any {
    Handler handler;
    explicit Held(Handler&& handler) : handler(std::move(handler)) {}
    explicit Held(const Handler& handler) : handler(handler) {}
    void call(error_code ec, size_t bytes) override {
      Handler last = std::move(handler);
      delete this;
      if constexpr (std::is_invocable_v<Handler&, error_code, size_t>) last(ec, bytes);
      else last(ec);
    }
  };
  std::unique_ptr<Any> held_;
};

// Holds the first buffers of a sequence: an operation that moves some bytes need not see all.
template <class Buffer>
struct SomeBuffers {
  using value_type = Buffer;
  std::array<Buffer, 8> list{};
  size_t count = 0;
  template <class Buffers>
  explicit SomeBuffers(const Buffers& buffers) {
    const auto end = net::buffer_sequence_end(buffers);
    for (auto it = net::buffer_sequence_begin(buffers); it != end && count < list.size(); ++it)
      if (const Buffer one = *it; one.size() > 0) list[count++] = one;
  }
  const Buffer* begin() const { return list.data(); }
  const Buffer* end() const { return list.data() + count; }
};

class Transport {
 public:
  using executor_type = beast::tcp_stream::executor_type;
  // Judges bytes as they come; false: no more is read from now on, until the connection is closed.
  using Watch = std::function<bool(std::span<const uint8_t>)>;

  explicit Transport(tcp::socket socket);
  ~Transport();
  Transport(const Transport&) = delete;

  executor_type get_executor() noexcept;
  tcp::socket& socket();
  void expires_after(double seconds);  // for operations that begin from now on, until changed
  void expires_never();
  void close();
  void cut();  // resets: bytes that the kernel holds for the peer are thrown away
  void watch(Watch watch);
  bool secure() const;

  // Does the server's part of a TLS handshake, whose first bytes may have been read already.
  net::awaitable<error_code> shake_hands(std::shared_ptr<Certificate::Context> context,
                                         beast::flat_buffer& read_already);
  // Ends and closes the connection so that the peer gets all that was written: closing a socket
  // with unread input would reset it.
  net::awaitable<void> linger(double most_seconds);

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return net::async_initiate<Token, void(error_code, size_t)>(
        [this](auto&& handler, const SomeBuffers<net::mutable_buffer>& some) {
          read(some, Completion(std::forward<decltype(handler)>(handler)));
        },
        token, SomeBuffers<net::mutable_buffer>(buffers));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return net::async_initiate<Token, void(error_code, size_t)>(
        [this](auto&& handler, const SomeBuffers<net::const_buffer>& some) {
          write(some, Completion(std::forward<decltype(handler)>(handler)));
        },
        token, SomeBuffers<net::const_buffer>(buffers));
  }
  void tear_down(Completion done);  // after the closing handshake of a WebSocket

 private:
  struct State;
  void read(const SomeBuffers<net::mutable_buffer>& buffers, Completion done);
  void write(const SomeBuffers<net::const_buffer>& buffers, Completion done);
  std::shared_ptr<State> state_;  // operations under way hold it, too
};

// Beast calls these two for a stream below a WebSocket.
template <class Handler>
void async_teardown(beast::role_type, Transport& transport, Handler&& handler) {
  transport.tear_down(Completion(std::forward<Handler>(handler)));
}
inline void beast_close_socket(Transport& transport) { transport.close(); }

}  // namespace wellspring::stream
