// SPDX-License-Identifier: Apache-2.0
#include "store/remote/http_get.h"

#include <algorithm>
#include <utility>  // Boost 1.74's awaitable.hpp uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <fmt/format.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "base/load_error.h"

namespace wellspring::store {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Answer = http::response<http::vector_body<uint8_t>>;

constexpr uint32_t most_header_bytes = 16 << 10;
constexpr int most_redirects = 4;
constexpr size_t most_address_bytes = 2000;

auto into(error_code& ec) { return asio::redirect_error(asio::use_awaitable, ec); }

std::string port_text(const HttpAddress& address) { return std::to_string(address.port); }

bool is_usual(const HttpAddress& address) { return address.port == (address.tls ? 443 : 80); }

std::string bracketed(const std::string& host) {
  return host.find(':') == host.npos ? host : "[" + host + "]";
}

// Believes those whom the system believes.
asio::ssl::context& trust() {
  static asio::ssl::context context = [] {
    asio::ssl::context made(asio::ssl::context::tls_client);
    SSL_CTX_set_min_proto_version(made.native_handle(), TLS1_2_VERSION);
    made.set_verify_mode(asio::ssl::verify_peer);
    error_code ignored;
    made.set_default_verify_paths(ignored);
    return made;
  }();
  return context;
}

// Sets the host that the certificate must name.
void expect_host(SSL* tls, const std::string& host) {
  error_code no_address;
  asio::ip::make_address(host, no_address);
  if (no_address) {
    SSL_set_tlsext_host_name(tls, host.c_str());
    SSL_set1_host(tls, host.c_str());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(tls), host.c_str());
  }
}

// Makes one request and reads its answer.
struct Asking {
  const HttpAddress& address;
  const HttpLimits& limits;
  std::string problem;  // why there is no answer
  std::optional<Answer> answer;
  asio::io_context io{1};

  asio::awaitable<void> connect(beast::tcp_stream& socket) {
    error_code ec;
    tcp::resolver resolver(io);
    const auto places = co_await resolver.async_resolve(address.host, port_text(address), into(ec));
    if (!ec) co_await socket.async_connect(places, into(ec));
    if (ec) problem = "cannot be reached: " + ec.message();
  }

  template <class Socket>
  asio::awaitable<void> exchange(Socket& socket) {
    error_code ec;
    http::request<http::empty_body> request(http::verb::get, address.path, 11);
    const std::string host = bracketed(address.host);
    request.set(http::field::host, is_usual(address) ? host : host + ":" + port_text(address));
    request.set(http::field::user_agent, "Wellspring");
    request.set(http::field::accept, limits.accept);
    request.set(http::field::connection, "close");
    co_await http::async_write(socket, request, into(ec));
    beast::flat_buffer buffer(most_header_bytes);
    http::response_parser<http::vector_body<uint8_t>> parser;
    parser.header_limit(most_header_bytes);
    parser.body_limit(limits.most_bytes);
    if (!ec) co_await http::async_read_header(socket, buffer, parser, into(ec));
    // Boost 1.74 forgets its limit where bytes of the body come with the header.
    const auto is_too_long = [&] {
      const auto told = parser.content_length();
      return (told && *told > limits.most_bytes) || parser.get().body().size() > limits.most_bytes;
    };
    bool too_long = ec == http::error::body_limit || (!ec && is_too_long());
    while (!ec && !too_long && !parser.is_done()) {
      co_await http::async_read_some(socket, buffer, parser, into(ec));
      too_long = ec == http::error::body_limit || is_too_long();
    }
    if (too_long) problem = fmt::format("answers with more than {} bytes", limits.most_bytes);
    else if (ec) problem = "breaks off: " + ec.message();
    else answer = parser.release();
  }

  asio::awaitable<void> talk(Clock::time_point deadline) {
    if (!address.tls) {
      beast::tcp_stream socket(io);
      socket.expires_at(deadline);
      co_await connect(socket);
      if (problem.empty()) co_await exchange(socket);
      co_return;
    }
    beast::ssl_stream<beast::tcp_stream> socket(io, trust());
    beast::get_lowest_layer(socket).expires_at(deadline);
    co_await connect(beast::get_lowest_layer(socket));
    if (!problem.empty()) co_return;
    SSL* tls = socket.native_handle();
    expect_host(tls, address.host);
    error_code ec;
    co_await socket.async_handshake(asio::ssl::stream_base::client, into(ec));
    if (const long verdict = SSL_get_verify_result(tls); ec && verdict != X509_V_OK)
      problem = std::string("has a certificate that is not accepted: ") +
                X509_verify_cert_error_string(verdict);
    else if (ec) problem = "speaks no TLS: " + ec.message();
    else co_await exchange(socket);
  }

  void run(Clock::time_point deadline) {
    asio::co_spawn(io, talk(deadline), asio::detached);
    io.run_until(deadline + std::chrono::seconds(1));
    if (answer) return;
    if (problem.empty() || Clock::now() >= deadline)
      problem = fmt::format("does not answer within {:g} s", limits.seconds);
  }
};

bool is_redirect(unsigned status) {
  return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

// Returns the address that a redirect names: a whole one, or a path of the same server.
std::optional<HttpAddress> follow(const HttpAddress& from, std::string_view location) {
  if (is_http_address(location)) return read_http_address(location);
  const std::string site =
      (from.tls ? "https://" : "http://") + bracketed(from.host) + ":" + port_text(from);
  if (location.starts_with("//"))
    return read_http_address((from.tls ? "https:" : "http:") + std::string(location));
  if (location.starts_with("/")) return read_http_address(site + std::string(location));
  const std::string folder =
      from.path.substr(0, from.path.substr(0, from.path.find('?')).rfind('/') + 1);
  return read_http_address(site + folder + std::string(location));
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = char(c | 0x20);
  return small;
}

}  // namespace

bool is_http_address(std::string_view text) {
  const std::string begin = small_letters(text.substr(0, 8));
  return begin.starts_with("http://") || begin == "https://";
}

std::optional<HttpAddress> read_http_address(std::string_view text) {
  if (!is_http_address(text) || text.size() > most_address_bytes) return {};
  if (std::ranges::any_of(text, [](char c) { return uint8_t(c) <= ' ' || uint8_t(c) >= 127; }))
    return {};
  HttpAddress address;
  address.tls = text[4] != ':';
  text.remove_prefix(address.tls ? 8 : 7);
  text = text.substr(0, text.find('#'));
  const size_t end = std::min(text.find_first_of("/?"), text.size());
  std::string_view place = text.substr(0, end);
  text.remove_prefix(end);
  address.path = (text.starts_with('/') ? "" : "/") + std::string(text);
  if (place.find_first_of("@\\") != place.npos) return {};
  const size_t close = place.starts_with('[') ? place.find(']') : 0;
  if (close == place.npos) return {};
  const size_t colon = place.find(':', close);
  address.host = small_letters(place.substr(0, colon));
  if (close > 0) {
    if (address.host.back() != ']') return {};
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  if (address.host.empty() || address.host.find_first_of("[]") != address.host.npos) return {};
  address.port = address.tls ? 443 : 80;
  if (colon == place.npos) return address;
  const std::string_view digits = place.substr(colon + 1);
  if (digits.empty() || digits.size() > 5 || digits.find_first_not_of("0123456789") != digits.npos)
    return {};
  const int port = std::stoi(std::string(digits));
  if (port < 1 || port > 65535) return {};
  address.port = uint16_t(port);
  return address;
}

std::string host_text(const HttpAddress& address) {
  const std::string host = bracketed(address.host);
  return is_usual(address) ? host : host + ":" + port_text(address);
}

bool is_allowed(const HttpAddress& address, const std::vector<std::string>& hosts) {
  const std::string host = bracketed(address.host);
  const bool usual = address.port == 80 || address.port == 443;
  return std::ranges::any_of(hosts, [&](const std::string& allowed) {
    const std::string small = small_letters(allowed);
    return small == host + ":" + port_text(address) || (usual && small == host);
  });
}

std::optional<std::vector<uint8_t>> http_get(const std::string& text, const HttpLimits& limits) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(limits.seconds));
  std::optional<HttpAddress> address = read_http_address(text);
  if (!address) throw LoadError(text, "", "is no http or https address");
  for (int step = 0; step < most_redirects; step++) {
    if (!is_allowed(*address, limits.hosts))
      throw LoadError(text, "", "host '" + host_text(*address) + "' is not allowed");
    Asking asking{*address, limits, {}, {}};
    asking.run(deadline);
    if (!asking.answer) throw LoadError(text, "", asking.problem);
    Answer& answer = *asking.answer;
    const unsigned status = answer.result_int();
    if (status == 200) return std::move(answer.body());
    if (status == 404 || status == 410) return {};
    if (!is_redirect(status))
      throw LoadError(text, "", "is answered with status " + std::to_string(status));
    const auto location = answer[http::field::location];
    const auto next = follow(*address, {location.data(), location.size()});
    if (!next || next->host != address->host || (address->tls && !next->tls))
      throw LoadError(text, "", "leads to another host: that is not followed");
    address = next;
  }
  throw LoadError(text, "", "leads from one address to another, too many times");
}

}  // namespace wellspring::store
