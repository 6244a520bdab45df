// SPDX-License-Identifier: Apache-2.0
// The HTTP half of a session: read a request, judge it, let a worker answer, write, and again.
#include <chrono>
#include <ctime>

#include "base/log.h"
#include "stream/origin.h"
#include "stream/reply.h"
#include "stream/session.h"
#include "stream/target.h"

namespace wellspring {

static constexpr std::string_view subprotocol = "wellspring.v1";

static std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

static std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[64];
  std::strftime(text, sizeof(text), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return text;
}

// 200 with `request` filled, a status to refuse with, or 0: nobody there to be told.
net::awaitable<int> Session::read_request(Request& request) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(max_header_bytes);
  parser.body_limit(max_body_bytes);
  stream().expires_after(seconds(core_->settings.header_timeout));  // for all of it, however slow
  error_code ec;
  reading_ = true;  // stop() may close
  co_await http::async_read_header(stream(), buffer_, parser,
                                   net::redirect_error(net::use_awaitable, ec));
  const http::verb method = ec ? http::verb::unknown : parser.get().method();
  if (!ec && method != http::verb::get && method != http::verb::head) co_return 405;
  if (!ec && !parser.is_done())
    co_await http::async_read(stream(), buffer_, parser,
                              net::redirect_error(net::use_awaitable, ec));
  if (!ec) {
    request = parser.release();
    co_return 200;
  }
  if (ec == http::error::header_limit || ec == http::error::buffer_overflow) co_return 431;
  if (ec == http::error::body_limit) co_return 413;
  if (ec == http::error::end_of_stream || ec == http::error::partial_message) co_return 0;
  const bool not_http = ec.category() == make_error_code(http::error::end_of_stream).category();
  fail(ec, "read request");
  co_return not_http ? 400 : 0;
}

net::awaitable<void> Session::serve_http() {
  while (!stopping_) {
    Request request;
    HttpQuestion question;
    const int status = co_await read_request(request);
    reading_ = false;
    if (status == 0) co_return;
    core_->http_requests++;
    if (status != 200) {
      const char* what = status == 405   ? "only GET and HEAD"
                         : status == 413 ? "request body too large"
                         : status == 431 ? "request header too large"
                                         : "not an HTTP request";
      co_await write_refusal(std::move(question), status, what);
      co_return;
    }
    question.method = std::string(request.method_string());
    if (request.version() >= 11 && request.count(http::field::host) != 1) {
      co_await write_refusal(std::move(question), 400, "exactly one Host header");
      co_return;
    }
    const int target_status = read_target(view(request.target()), question);
    if (target_status != 200) {
      co_await write_refusal(std::move(question), target_status, "bad request target");
      co_return;
    }
    question.if_none_match = std::string(request[http::field::if_none_match]);

    const bool websocket_path = question.path == "/api/v1/visit" || question.path == "/api/v1/eye";
    const bool upgrade = websocket::is_upgrade(request);
    HttpReply reply;
    if (websocket_path || upgrade) {
      reply = judge_upgrade(question, request);
      if (reply.status == 101) {
        upgrade_ = std::make_unique<Request>(std::move(request));
        co_return;
      }
    } else {
      reply = co_await ask(question);
    }
    const bool keep = request.keep_alive() && !upgrade && !stopping_;
    const bool go_on =
        co_await write_reply(std::move(question), std::move(reply), request.version(), keep);
    if (!go_on) break;
  }
  co_await linger();
}

// 101 when a WebSocket may be opened, else the refusal.
HttpReply Session::judge_upgrade(const HttpQuestion& question, const Request& request) const {
  const bool visit = question.path == "/api/v1/visit", eye = question.path == "/api/v1/eye";
  if (!visit && !eye) return make_refusal(404, "no WebSocket here");
  if (!websocket::is_upgrade(request)) {
    HttpReply reply = make_refusal(426, "open this as a WebSocket");
    reply.headers["Upgrade"] = "websocket";
    return reply;
  }
  if (view(request[http::field::sec_websocket_version]) != "13") {
    HttpReply reply = make_refusal(426, "WebSocket version 13 only");
    reply.headers["Sec-WebSocket-Version"] = "13";
    return reply;
  }
  if (request[http::field::sec_websocket_key].size() != 24)
    return make_refusal(400, "bad Sec-WebSocket-Key");
  if (buffer_.size() != 0) return make_refusal(400, "WebSocket data before the handshake");

  std::vector<std::string_view> origins;
  const auto origin_range = request.equal_range(http::field::origin);
  for (auto it = origin_range.first; it != origin_range.second; ++it)
    origins.push_back(view(it->value()));
  if (!origin_allowed(origins, view(request[http::field::host]), core_->settings.allowed_origin)) {
    log::debug("session {}: WebSocket from foreign origin refused", peer_);
    return make_refusal(403, "this origin may not open WebSockets here");
  }
  const auto offers = request.equal_range(http::field::sec_websocket_protocol);
  bool offered = offers.first == offers.second;
  for (auto it = offers.first; it != offers.second; ++it)
    offered = offered || offers_protocol(view(it->value()), subprotocol);
  if (!offered) return make_refusal(400, "subprotocol is wellspring.v1");
  HttpReply reply;
  reply.status = 101;
  return reply;
}

// On a worker thread; this coroutine sleeps meanwhile.
net::awaitable<HttpReply> Session::ask(HttpQuestion question) {
  auto reply = std::make_shared<HttpReply>();
  const bool slow = core_->doors.slow && core_->doors.slow(question);
  Workers& workers = slow ? core_->slow_workers : core_->workers;
  const bool posted = workers.post([self = shared_from_this(), question, reply](bool run) {
    try {
      *reply = run ? self->core_->doors.answer(question) : make_refusal(503, "server stops");
    } catch (const std::exception& e) {
      log::error("answer to {}: {}", question.path, e.what());
      *reply = make_refusal(500, "internal error");
    }
    net::post(self->ws_.get_executor(), [self] { self->answered_.raise(); });
  });
  if (!posted) {
    *reply = make_refusal(503, "too busy");
    reply->headers["Retry-After"] = "2";
    co_return std::move(*reply);
  }
  co_await answered_.wait();
  co_return std::move(*reply);
}

net::awaitable<void> Session::write_refusal(HttpQuestion question, int status,
                                            std::string message) {
  HttpReply reply = make_refusal(status, message);
  if (status == 405) reply.headers["Allow"] = "GET, HEAD";
  co_await write_reply(std::move(question), std::move(reply), 11, false);
  co_await linger();
}

// Headers of any message but Content-Length.
template <class Message>
static void put_headers(const HttpReply& reply, unsigned version, bool keep_alive,
                        Message& message) {
  message.version(version);
  message.result(unsigned(reply.status));
  message.set(http::field::server, "wellspring");
  message.set(http::field::date, http_date());
  for (const auto& [name, value] : security_headers()) message.set(name, value);
  if (reply.status != 304 && reply.status != 204)
    message.set(http::field::content_type, reply.content_type);
  for (const auto& [name, value] : reply.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  if (reply.status == 426)
    message.set(http::field::connection, keep_alive ? "Upgrade" : "Upgrade, close");
}

// True: the connection may be used again.
net::awaitable<bool> Session::write_reply(HttpQuestion question, HttpReply reply, unsigned version,
                                          bool keep_alive) {
  if (reply.status < 200 || reply.status > 599) {
    log::error("answer to {}: status {}", question.path, reply.status);
    reply = make_refusal(500, "internal error");
  }
  finish_reply(question, reply);
  const size_t body_bytes = reply.body.size();
  const bool may_have_body = reply.status != 304 && reply.status != 204;
  stream().expires_after(seconds(http_write_timeout));
  error_code ec;
  if (!may_have_body || question.method == "HEAD") {
    http::response<http::empty_body> message;
    put_headers(reply, version, keep_alive, message);
    if (may_have_body) message.content_length(body_bytes);
    co_await http::async_write(stream(), message, net::redirect_error(net::use_awaitable, ec));
  } else {
    http::response<http::string_body> message;
    put_headers(reply, version, keep_alive, message);
    message.content_length(body_bytes);
    message.body() = std::move(reply.body);
    co_await http::async_write(stream(), message, net::redirect_error(net::use_awaitable, ec));
  }
  log::debug("{} {} {} {} {}", peer_, question.method, question.path, reply.status, body_bytes);
  if (ec) fail(ec, "write reply");
  co_return !ec && keep_alive;
}

// Ends the connection so that the peer gets the reply whole: closing a socket with unread input
// would reset it.
net::awaitable<void> Session::linger() {
  error_code ec;
  stream().socket().shutdown(tcp::socket::shutdown_send, ec);
  stream().expires_after(std::chrono::seconds(1));
  reading_ = true;
  std::array<char, 4096> thrown_away;
  for (size_t total = 0; !ec && !stopping_ && total < 256 * 1024;)
    total += co_await stream().async_read_some(net::buffer(thrown_away),
                                               net::redirect_error(net::use_awaitable, ec));
  stream().close();
}

}  // namespace wellspring
