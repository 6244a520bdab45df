// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/link.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <functional>
#include <thread>

namespace wellspring::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

bool wait_for(const std::function<bool()>& done, double seconds = 60) {
  for (int i = 0; i < seconds * 200; i++) {
    if (done()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return done();
}

// A server of one connection at a time, blocking, on a free port. `closed`: nobody can connect
// until open() is called, but the port is nobody else's either.
struct SmallServer {
  asio::io_context io;
  tcp::acceptor acceptor;
  explicit SmallServer(bool closed = false) : acceptor(io, tcp::v4()) {
    acceptor.bind(tcp::endpoint(asio::ip::address_v4::loopback(), 0));
    if (!closed) open();
  }
  void open() { acceptor.listen(); }
  uint16_t port() const { return acceptor.local_endpoint().port(); }
  beast::websocket::stream<tcp::socket> accept(std::string* target = nullptr) {
    tcp::socket socket(io);
    acceptor.accept(socket);
    beast::websocket::stream<tcp::socket> stream(std::move(socket));
    beast::flat_buffer buffer;
    beast::http::request<beast::http::string_body> request;
    beast::http::read(stream.next_layer(), buffer, request);
    if (target) *target = std::string(request.target());
    stream.accept(request);
    return stream;
  }
};

std::string read(beast::websocket::stream<tcp::socket>& stream) {
  beast::flat_buffer buffer;
  boost::system::error_code ec;
  stream.read(buffer, ec);
  return ec ? "" : beast::buffers_to_string(buffer.data());
}

TEST(Link, addresses) {
  auto a = parse_address("ws://127.0.0.1:8080");
  ASSERT_TRUE(a);
  EXPECT_EQ(a->host, "127.0.0.1");
  EXPECT_EQ(a->port, "8080");
  EXPECT_EQ(a->path, "/api/v1/eye");
  a = parse_address("ws://museum.example/other");
  ASSERT_TRUE(a);
  EXPECT_EQ(a->port, "80");
  EXPECT_EQ(a->path, "/other");
  EXPECT_FALSE(a->tls);
  a = parse_address("wss://museum.example");
  ASSERT_TRUE(a);
  EXPECT_TRUE(a->tls);
  EXPECT_EQ(a->port, "443");
  a = parse_address("ws://[::1]:9/");
  ASSERT_TRUE(a);
  EXPECT_EQ(a->host, "::1");
  EXPECT_EQ(a->port, "9");
  EXPECT_EQ(a->path, "/api/v1/eye");
  for (const char* bad : {"", "ws://", "wss://", "wss:/a", "http://a", "127.0.0.1:80", "ws://a:",
                          "ws://a:0", "ws://a:65536", "ws://a:x", "ws://:80", "ws://[::1",
                          "ws://[::1]x", "ws://a b", "ws://::1:80", "ws://a/\r\nX: y", "ws://a@b"})
    EXPECT_FALSE(parse_address(bad)) << bad;
}

TEST(Link, pauses_double_up_to_a_limit_with_jitter) {
  EXPECT_DOUBLE_EQ(retry_pause(1, 0.25, 5, 1), 0.25);
  EXPECT_DOUBLE_EQ(retry_pause(1, 0.25, 5, 0), 0.125);
  EXPECT_DOUBLE_EQ(retry_pause(3, 0.25, 5, 1), 1);
  EXPECT_DOUBLE_EQ(retry_pause(100000, 0.25, 5, 1), 5);
  EXPECT_DOUBLE_EQ(retry_pause(100000, 0.25, 5, 0), 2.5);
}

TEST(Link, the_last_text_arrives_before_the_goodbye) {
  SmallServer server;
  std::string target, got;
  bool closed = false;
  std::thread listener([&] {
    auto stream = server.accept(&target);
    for (std::string text; !(text = read(stream)).empty();) got = text;
    closed = stream.reason().code == beast::websocket::close_code::normal;
  });
  {
    ServerLink link({"127.0.0.1", std::to_string(server.port()), "/api/v1/eye"});
    ASSERT_TRUE(wait_for([&] { return link.connected(); }));
    for (int i = 0; i < 50; i++) link.send("observation " + std::to_string(i));
  }
  listener.join();
  EXPECT_EQ(target, "/api/v1/eye");
  EXPECT_EQ(got, "observation 49");
  EXPECT_TRUE(closed);
}

TEST(Link, without_a_server_the_newest_waits_and_is_sent_on_reconnect) {
  SmallServer server(true);
  ServerLinkSettings settings{0.02, 0.05, 2};
  ServerLink link({"127.0.0.1", std::to_string(server.port()), "/api/v1/eye"}, settings);
  for (int i = 0; i < 1000; i++) link.send("old " + std::to_string(i));
  link.send("new");
  EXPECT_FALSE(link.connected());
  server.open();
  {
    auto stream = server.accept();
    EXPECT_EQ(read(stream), "new");
  }  // cut without a goodbye
  ASSERT_TRUE(wait_for([&] { return !link.connected(); }));
  auto stream = server.accept();
  ASSERT_TRUE(wait_for([&] { return link.connected(); }));
  link.send("again");
  EXPECT_EQ(read(stream), "again");
  EXPECT_EQ(link.connections(), 2u);
  EXPECT_TRUE(wait_for([&] { return link.sent() == 2; }));
}

TEST(Link, a_server_that_reads_nothing_costs_one_text) {
  SmallServer server;
  ServerLinkSettings settings{0.02, 0.05, 60};
  ServerLink link({"127.0.0.1", std::to_string(server.port()), "/api/v1/eye"}, settings);
  auto stream = server.accept();
  ASSERT_TRUE(wait_for([&] { return link.connected(); }));
  // Far more than the socket's buffers hold; every call returns at once and only the newest is
  // kept.
  const std::string big(256 * 1024, 'x');
  for (int i = 0; i < 400; i++) link.send(big);
  link.send("last");
  EXPECT_LT(link.sent(), 400u);
  std::string text;
  while ((text = read(stream)) == big) {}
  EXPECT_EQ(text, "last");
}

TEST(Link, the_newest_order_is_kept_and_other_words_are_not) {
  SmallServer server;
  ServerLink link({"127.0.0.1", std::to_string(server.port()), "/api/v1/eye"});
  auto stream = server.accept();
  EXPECT_FALSE(link.take_order());
  for (const char* text : {R"({"type":"kiosk","stage":"sleep"})",
                           R"({"type":"kiosk","stage":"person","needs":{"gestures":false}})",
                           R"({"type":"error","code":"bad_field","message":"x"})", "{"})
    stream.write(asio::buffer(std::string(text)));
  std::optional<EyeOrder> order;
  ASSERT_TRUE(wait_for([&] {
    if (auto found = link.take_order()) order = found;
    return order && order->stage == "person";
  }));
  EXPECT_FALSE(order->needs.gestures);
  EXPECT_TRUE(order->needs.expression);
  stream.write(asio::buffer(std::string(R"({"type":"kiosk","stage":"awake"})")));
  ASSERT_TRUE(wait_for([&] { return (order = link.take_order()).has_value(); }));
  EXPECT_EQ(order->stage, "awake");
}

TEST(Link, something_that_is_no_websocket_server_is_survived) {
  SmallServer server;
  std::thread liar([&] {
    for (int i = 0; i < 2; i++) {
      tcp::socket socket(server.io);
      server.acceptor.accept(socket);
      boost::system::error_code ec;
      asio::write(socket, asio::buffer(std::string("220 mail ready\r\n\r\n")), ec);
    }
  });
  ServerLinkSettings settings{0.02, 0.05, 1};
  ServerLink link({"127.0.0.1", std::to_string(server.port()), "/"}, settings);
  liar.join();  // it came back after the first lie
  EXPECT_EQ(link.connections(), 0u);
}

}  // namespace
}  // namespace wellspring::test
