// SPDX-License-Identifier: Apache-2.0
#include "kiosk/process/link.h"

#include <algorithm>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>  // first: Boost 1.74's awaitable.hpp uses it without including it

#include "base/log.h"
#include "base/worker.h"
#include "wire/json.h"

namespace wellspring::kiosk {

std::optional<ServerAddress> parse_address(const std::string& url) {
  ServerAddress address;
  address.tls = url.starts_with("wss://");
  if (!address.tls && !url.starts_with("ws://")) return {};
  if (address.tls) address.port = "443";
  std::string rest = url.substr(address.tls ? 6 : 5);
  for (unsigned char c : rest)
    if (c <= ' ' || c == 127 || c == '#' || c == '@' || c == '\\') return {};
  size_t slash = rest.find('/');
  address.path = slash == std::string::npos ? "" : rest.substr(slash);
  if (address.path.empty() || address.path == "/") address.path = "/api/v1/eye";
  std::string place = rest.substr(0, slash);
  size_t colon = place.rfind(':');
  if (!place.empty() && place[0] == '[') {
    size_t end = place.find(']');
    if (end == std::string::npos) return {};
    address.host = place.substr(1, end - 1);
    if (end + 1 == place.size()) colon = std::string::npos;
    else if (place[end + 1] != ':') return {};
    else colon = end + 1;
  } else {
    address.host = place.substr(0, colon);
    if (address.host.find(':') != std::string::npos) return {};
  }
  if (address.host.empty()) return {};
  if (colon != std::string::npos) {
    address.port = place.substr(colon + 1);
    if (address.port.empty() || address.port.size() > 5 ||
        address.port.find_first_not_of("0123456789") != std::string::npos)
      return {};
    int port = std::stoi(address.port);
    if (port < 1 || port > 65535) return {};
  }
  return address;
}

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr size_t largest_answer = 64 * 1024;  // bytes of a server's message to a kiosk
constexpr uint64_t largest_document = 32 << 20;

std::chrono::steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(s));
}
auto into(error_code& ec) { return asio::redirect_error(asio::use_awaitable, ec); }

}  // namespace

double retry_pause(int attempt, double first, double longest, double jitter) {
  double pause = first * std::pow(2.0, std::clamp(attempt - 1, 0, 30));
  return std::min(pause, longest) * (0.5 + 0.5 * std::clamp(jitter, 0.0, 1.0));
}

struct ServerLink::Impl {
  ServerAddress address;
  ServerLinkSettings settings;
  asio::io_context io{1};
  asio::ssl::context trust{asio::ssl::context::tls_client};  // certificates for TLS
  asio::steady_timer wake{io};  // cancelled when there is something to send or it is time to go
  Latest<std::string> newest;
  Latest<EyeOrder> order;
  Latest<std::string> document;
  std::atomic<bool> connected{false}, leaving{false};
  std::atomic<uint64_t> sent{0}, connections{0};
  std::thread thread;
  using PlainSocket = websocket::stream<beast::tcp_stream>;
  using TlsSocket = websocket::stream<beast::ssl_stream<beast::tcp_stream>>;

  // Chooses whose certificates are believed. Throws std::runtime_error.
  void choose_trust() {
    SSL_CTX_set_min_proto_version(trust.native_handle(), TLS1_2_VERSION);
    trust.set_verify_mode(asio::ssl::verify_peer);
    error_code ec;
    if (settings.ca_file.empty()) trust.set_default_verify_paths(ec);
    else trust.load_verify_file(settings.ca_file, ec);
    if (ec && !settings.ca_file.empty())
      throw std::runtime_error(settings.ca_file + ": no certificates in PEM: " + ec.message());
  }

  void nudge() {
    asio::post(io, [this] { wake.cancel(); });
  }

  // Reads the server's orders, also so that pings are answered and a close is noticed.
  template <class Socket>
  asio::awaitable<void> listen(std::shared_ptr<Socket> socket, std::shared_ptr<bool> open) {
    beast::flat_buffer buffer;
    error_code ec;
    while (!ec) {
      co_await socket->async_read(buffer, into(ec));
      auto said = read_eye_order(beast::buffers_to_string(buffer.data()));
      if (EyeOrder* found = ec ? nullptr : std::get_if<EyeOrder>(&said))
        order.put(std::move(*found));
      buffer.consume(buffer.size());
    }
    *open = false;
    wake.cancel();
  }

  // Returns why the server did not open the connection.
  std::string refusal(const error_code& ec, unsigned status) const {
    if (ec != websocket::error::upgrade_declined) return ec.message();
    if (status == 308) return "it asks for TLS: --server wss://..., or --trusted ADDRESS there";
    if (status != 401) return "HTTP status " + std::to_string(status);
    return settings.token.empty()
               ? "it trusts cameras on other machines by a kiosk token alone: --token-file FILE"
               : "it does not know this kiosk token";
  }

  // Sets the host that the certificate must name.
  void expect_host(SSL* tls) const {
    error_code no_address;
    asio::ip::make_address(address.host, no_address);
    if (no_address) {
      SSL_set_tlsext_host_name(tls, address.host.c_str());
      SSL_set1_host(tls, address.host.c_str());
    } else {
      X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(tls), address.host.c_str());
    }
  }

  // Returns why TLS did not begin.
  std::string distrust(const error_code& ec, SSL* tls) const {
    const long verdict = SSL_get_verify_result(tls);
    if (verdict != X509_V_OK)
      return std::string("its certificate is not accepted: ") +
             X509_verify_cert_error_string(verdict) +
             (settings.ca_file.empty() ? "; --ca-file FILE names who has signed it" : "");
    return "TLS does not begin: " + ec.message();
  }

  asio::awaitable<error_code> connect(beast::tcp_stream& socket) {
    error_code ec;
    tcp::resolver resolver(io);
    auto places = co_await resolver.async_resolve(address.host, address.port, into(ec));
    if (ec) co_return ec;
    socket.expires_after(seconds(settings.patience));
    co_await socket.async_connect(places, into(ec));
    error_code ignored;
    if (!ec) socket.socket().set_option(tcp::no_delay(true), ignored);
    co_return ec;
  }

  // Begins TLS. Returns why it does not; empty: it does.
  asio::awaitable<std::string> begin_tls(beast::ssl_stream<beast::tcp_stream>& socket) {
    SSL* tls = socket.native_handle();
    error_code ec;
    expect_host(tls);
    co_await socket.async_handshake(asio::ssl::stream_base::client, into(ec));
    co_return ec ? distrust(ec, tls) : "";
  }

  // Runs one connection from its start to its end. Returns why it ended.
  asio::awaitable<std::string> talk() {
    if (!address.tls) {
      auto socket = std::make_shared<PlainSocket>(io);
      if (error_code ec = co_await connect(socket->next_layer())) co_return ec.message();
      co_return co_await talk_over(socket);
    }
    auto socket = std::make_shared<TlsSocket>(io, trust);
    if (error_code ec = co_await connect(beast::get_lowest_layer(*socket))) co_return ec.message();
    const std::string why = co_await begin_tls(socket->next_layer());
    if (!why.empty()) co_return why;
    co_return co_await talk_over(socket);
  }

  // Asks for the document, on a connection of its own. Returns why it did not come.
  asio::awaitable<std::string> ask_document() {
    beast::ssl_stream<beast::tcp_stream> socket(io, trust);
    if (error_code ec = co_await connect(socket.next_layer())) co_return ec.message();
    if (!address.tls) co_return co_await ask_document_over(socket.next_layer());
    const std::string why = co_await begin_tls(socket);
    if (!why.empty()) co_return why;
    co_return co_await ask_document_over(socket);
  }

  template <class Socket>
  asio::awaitable<std::string> ask_document_over(Socket& socket) {
    namespace http = beast::http;
    http::request<http::empty_body> question(http::verb::get, settings.document, 11);
    question.set(http::field::host, host());
    question.set(http::field::user_agent, "wellspring-kiosk");
    if (!settings.token.empty())
      question.set(http::field::authorization, "Bearer " + settings.token);
    error_code ec;
    co_await http::async_write(socket, question, into(ec));
    if (ec) co_return ec.message();
    beast::flat_buffer buffer;
    http::response_parser<http::string_body> answer;
    answer.body_limit(largest_document);
    beast::get_lowest_layer(socket).expires_after(seconds(4 * settings.patience));
    co_await http::async_read(socket, buffer, answer, into(ec));
    if (ec) co_return ec.message();
    const unsigned status = answer.get().result_int();
    if (status != 200 && status != 404) co_return "HTTP status " + std::to_string(status);
    document.put(status == 200 ? std::move(answer.get().body()) : std::string());
    co_return "";
  }

  // Asks until the document is there: a server that loads says that it has nothing yet.
  asio::awaitable<void> fetch_document() {
    const uint64_t connection = connections;
    std::string told;
    while (connected && !leaving && connections == connection) {
      const std::string why = co_await ask_document();
      if (why.empty()) co_return;
      if (why != told) log::warn("{} does not come ({}); trying again", settings.document, why);
      told = why;
      asio::steady_timer pause(io, seconds(settings.longest_pause));
      error_code ignored;
      co_await pause.async_wait(into(ignored));
    }
  }

  std::string host() const {
    const bool six = address.host.find(':') != std::string::npos;
    return (six ? "[" + address.host + "]" : address.host) + ":" + address.port;
  }

  template <class Socket>
  asio::awaitable<std::string> talk_over(std::shared_ptr<Socket> socket) {
    error_code ec, ignored;
    socket->read_message_max(largest_answer);
    socket->set_option(websocket::stream_base::decorator([this](websocket::request_type& request) {
      request.set(beast::http::field::user_agent, "wellspring-kiosk");
      if (!settings.token.empty())
        request.set(beast::http::field::authorization, "Bearer " + settings.token);
    }));
    websocket::response_type response;
    co_await socket->async_handshake(response, host(), address.path, into(ec));
    if (ec) co_return refusal(ec, response.result_int());
    beast::get_lowest_layer(*socket).expires_never();
    // A server that vanished without a word is noticed by its missing answer to a ping.
    websocket::stream_base::timeout limits{seconds(settings.patience),
                                           seconds(2 * settings.patience), true};
    socket->set_option(limits);
    socket->text(true);

    connections++;
    connected = true;
    log::info("connected to {}://{}{}", address.tls ? "wss" : "ws", host(), address.path);
    if (!settings.document.empty()) asio::co_spawn(io, fetch_document(), asio::detached);
    auto open = std::make_shared<bool>(true);
    asio::co_spawn(io, listen(socket, open), asio::detached);
    while (*open && !ec) {
      std::optional<std::string> text = newest.take();
      if (!text) {
        if (leaving) break;
        wake.expires_at(std::chrono::steady_clock::time_point::max());
        error_code woken;
        co_await wake.async_wait(into(woken));
        continue;
      }
      // The stream's own limits do not cover writes: a server that stops reading is given up here.
      asio::steady_timer patience(io, seconds(settings.patience));
      patience.async_wait([socket](error_code expired) {
        if (!expired) beast::get_lowest_layer(*socket).close();
      });
      co_await socket->async_write(asio::buffer(*text), into(ec));
      if (!ec) sent++;
    }
    connected = false;
    if (*open && !ec) co_await socket->async_close(websocket::close_code::normal, into(ignored));
    beast::get_lowest_layer(*socket).close();
    co_return ec ? ec.message() : "closed";
  }

  asio::awaitable<void> run() {
    std::mt19937 random(std::random_device{}());
    std::uniform_real_distribution<double> uniform(0, 1);
    int attempt = 0;
    std::string told;  // reason of the last failure that was logged
    while (!leaving) {
      uint64_t before = connections;
      const std::string why = co_await talk();
      if (leaving) break;
      if (connections != before) attempt = 0, told.clear();
      if (told != why)
        log::warn("no connection to {}:{} ({}); trying again", address.host, address.port, why);
      told = why;
      asio::steady_timer pause(io, seconds(retry_pause(++attempt, settings.first_pause,
                                                       settings.longest_pause, uniform(random))));
      error_code ignored;
      co_await pause.async_wait(into(ignored));
    }
    io.stop();
  }
};

ServerLink::ServerLink(const ServerAddress& address, const ServerLinkSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  impl_->address = address;
  impl_->settings = settings;
  if (address.tls) impl_->choose_trust();
  asio::co_spawn(impl_->io, impl_->run(), asio::detached);
  impl_->thread = std::thread([impl = impl_.get()] { impl->io.run(); });
}

ServerLink::~ServerLink() {
  impl_->leaving = true;
  // The last text has one second if there is a connection, none if there is not.
  auto limit =
      std::make_shared<asio::steady_timer>(impl_->io, seconds(impl_->connected ? 1.0 : 0.0));
  limit->async_wait([impl = impl_.get(), limit](error_code) { impl->io.stop(); });
  impl_->nudge();
  impl_->thread.join();
}

void ServerLink::send(std::string text) {
  impl_->newest.put(std::move(text));
  impl_->nudge();
}
std::optional<EyeOrder> ServerLink::take_order() { return impl_->order.take(); }
std::optional<std::string> ServerLink::take_document() { return impl_->document.take(); }
bool ServerLink::connected() const { return impl_->connected; }
uint64_t ServerLink::sent() const { return impl_->sent; }
uint64_t ServerLink::connections() const { return impl_->connections; }

}  // namespace wellspring::kiosk
