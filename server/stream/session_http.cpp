// SPDX-License-Identifier: Apache-2.0
// Runs the HTTP half of a session: reads a request, judges it, lets a worker answer, writes, and
// again.
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>

#include "base/clock.h"
#include "base/log.h"
#include "stream/reply.h"
#include "stream/session.h"
#include "stream/target.h"

namespace wellspring::stream {

// Between looks whether the peer still waits.
static constexpr auto look_at_peer = std::chrono::milliseconds(200);
static constexpr std::string_view subprotocol = "wellspring.v1";

// This path alone takes a body, and nothing but a POST.
static constexpr std::string_view posted_path = "/api/v1/admin/announce";

static std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

static std::string http_date() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[64];
  std::strftime(text, sizeof(text), "%a, %d %b %Y %H:%M:%S GMT", &parts);
  return text;
}

static bool is_posted_path(std::string_view target) {
  return target.substr(0, target.find('?')) == posted_path;
}

// Joins the lines of a header that is a list.
static std::string list_of(const Request& request, beast::string_view name) {
  std::string list;
  const auto range = request.equal_range(name);
  for (auto it = range.first; it != range.second; ++it)
    list += (list.empty() ? "" : ",") + std::string(view(it->value()));
  return list;
}

// Pages of other sites may read what is below this path: browsers ask first what they may do.
static bool is_shared_path(std::string_view target) { return target.starts_with("/iiif/"); }

static const char* allowed_methods(const Request& request) {
  const std::string_view target = view(request.target());
  return is_posted_path(target)   ? "POST"
         : is_shared_path(target) ? "GET, HEAD, OPTIONS"
                                  : "GET, HEAD";
}

// Returns the site of a Host header; empty: it has none, or one that is no plain name.
static std::string site_of(const Request& request, bool secure) {
  const std::string_view host = view(request[http::field::host]);
  const bool plain = std::ranges::all_of(host, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(".-_:[]").find(c) != std::string_view::npos;
  });
  return host.empty() || !plain ? "" : (secure ? "https://" : "http://") + std::string(host);
}

// Returns whether a Content-Type is JSON, whatever its parameters.
static bool is_json(std::string_view type) {
  type = type.substr(0, type.find(';'));
  while (type.ends_with(' ') || type.ends_with('\t')) type.remove_suffix(1);
  return beast::iequals(beast::string_view(type.data(), type.size()), "application/json");
}

// Reads a request. Returns 200 with `request` filled, a status to refuse with, or 0: the peer has
// gone. At 405 `request` has the target.
net::awaitable<int> Session::read_request(Request& request) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(max_header_bytes);
  parser.body_limit(max_body_bytes);
  stream().expires_after(core_->settings.header_timeout);  // for the whole request, however slow
  error_code ec;
  reading_ = true;  // stop() may close
  co_await http::async_read_header(stream(), buffer_, parser,
                                   net::redirect_error(net::use_awaitable, ec));
  if (!ec) {
    const http::verb method = parser.get().method();
    const bool posts = is_posted_path(view(parser.get().target()));
    const bool asks = method == http::verb::options && is_shared_path(view(parser.get().target()));
    const bool reads = method == http::verb::get || method == http::verb::head || asks;
    if (posts ? method != http::verb::post : !reads) {
      request.target(parser.get().target());
      co_return 405;
    }
    const auto coding = parser.get()[http::field::transfer_encoding];
    if (!coding.empty() && !beast::iequals(coding, "chunked")) co_return 501;
    const auto length = parser.content_length();
    if (posts && length && *length > max_posted_bytes) co_return 413;
  }
  if (!ec && !parser.is_done())
    co_await http::async_read(stream(), buffer_, parser,
                              net::redirect_error(net::use_awaitable, ec));
  if (!ec) {
    request = parser.release();
    const bool too_large = request.body().size() > max_posted_bytes;
    co_return request.method() == http::verb::post&& too_large ? 413 : 200;
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
    core_->admission.begin_waiting(id_);
    const int status = co_await read_request(request);
    core_->admission.end_waiting(id_);
    reading_ = false;
    if (status == 0) co_return;
    core_->http_requests++;
    if (status != 200) {
      if (status == 405) {
        co_await write_refusal(std::move(question), status, "method not allowed",
                               allowed_methods(request));
        co_return;
      }
      const char* what = status == 413   ? "request body too large"
                         : status == 431 ? "request header too large"
                         : status == 501 ? "the only Transfer-Encoding is chunked"
                                         : "not an HTTP request";
      co_await write_refusal(std::move(question), status, what);
      co_return;
    }
    question.method = std::string(request.method_string());
    if (request.version() >= 11 && request.count(http::field::host) != 1) {
      co_await write_refusal(std::move(question), 400, "exactly one Host header");
      co_return;
    }
    HttpReply reply = judge_caller(request);
    if (reply.status == 200) reply = judge_host(request);
    if (reply.status != 200) {
      co_await write_reply(std::move(question), std::move(reply), request.version(), false);
      break;
    }
    const int target_status = read_target(view(request.target()), question);
    if (target_status != 200) {
      co_await write_refusal(std::move(question), target_status, "bad request target");
      co_return;
    }
    question.if_none_match = std::string(request[http::field::if_none_match]);
    question.accept = std::string(request[http::field::accept]);
    question.accept_encoding = list_of(request, "Accept-Encoding");
    question.range = std::string(request[http::field::range]);
    question.if_range = std::string(request[http::field::if_range]);
    question.authorization = std::string(request[http::field::authorization]);
    const bool is_forwarded = any_holds(core_->proxies, address_) &&
                              beast::iequals(request["X-Forwarded-Proto"], "https");
    question.site = site_of(request, stream().secure() || is_forwarded);
    question.local = is_local(request);
    question.address = to_string(caller_.address);

    const bool websocket_path = question.path == "/api/v1/visit" || question.path == "/api/v1/eye";
    const bool upgrade = websocket::is_upgrade(request);
    if (websocket_path || upgrade) {
      reply = judge_upgrade(question, request);
      if (reply.status == 101) {
        upgrade_ = std::make_unique<Request>(std::move(request));
        co_return;
      }
    } else if (request.method() == http::verb::post) {
      reply = judge_post(request);
      if (reply.status == 200) {
        question.body = std::move(request.body());
        reply = co_await ask(question);
      }
    } else {
      reply = co_await ask(question);
    }
    if (reply.status == 0) co_return;
    const bool keep = request.keep_alive() && !upgrade && !stopping_;
    const bool go_on =
        co_await write_reply(std::move(question), std::move(reply), request.version(), keep);
    if (!go_on) break;
  }
  co_await linger();
}

static bool is_proxied(const Request& request) {
  return std::any_of(request.begin(), request.end(),
                     [](const auto& field) { return is_proxy_header(view(field.name_string())); });
}

// Finds the client; nothing for a proxy's header that names no address.
std::optional<Caller> Session::find_caller(const Request& request) const {
  const auto client = find_client(address_, list_of(request, "X-Forwarded-For"), core_->proxies);
  if (!client) return std::nullopt;
  Caller caller{*client, any_holds(core_->trusted, *client), name_};
  if (*client != address_)
    caller.name = (caller.trusted ? to_string(*client) : shortened(*client)) + " by " + name_;
  // A proxy that no option names, or that does not name its client, must not lend its visitors this
  // machine's rights.
  if (caller.trusted && *client == address_ && is_proxied(request)) {
    caller.trusted = false;
    if (!core_->proxy_told.exchange(true))
      log::warn(
          "{0} forwards requests of others, who share its limits: if it is a reverse proxy that "
          "sets X-Forwarded-For, start with --trusted-proxy {0}",
          to_string(address_));
  }
  return caller;
}

static HttpReply make_too_many(Core& core, Admission::Taken taken, const char* what) {
  const bool in_all = taken == Admission::Taken::too_many_in_all;
  (in_all ? core.limited_in_all : core.limited)++;
  HttpReply reply = in_all ? make_refusal(503, "too much is asked from everywhere")
                           : make_refusal(429, std::string(what) + " from your address");
  reply.headers["Retry-After"] = "5";
  return reply;
}

HttpReply Session::judge_caller(const Request& request) {
  auto caller = find_caller(request);
  if (!caller) return make_refusal(400, "X-Forwarded-For names no address");
  caller_ = std::move(*caller);
  if (!caller_.trusted && reserved_) {
    HttpReply reply = make_refusal(503, "too many connections");
    reply.headers["Retry-After"] = "5";
    return reply;
  }
  if (caller_.trusted) return {};
  const Admission::Taken taken = core_->admission.take_request(caller_.address, seconds_now());
  return taken == Admission::Taken::yes ? HttpReply{}
                                        : make_too_many(*core_, taken, "too many requests");
}

// Refuses requests for a name that is not this server's, and sends plain requests to TLS if there
// is a certificate.
HttpReply Session::judge_host(const Request& request) const {
  if (request.count(http::field::host) == 0) return {};  // HTTP/1.0: no browser
  const std::string_view header = view(request[http::field::host]);
  const std::string name = host_name(header);
  if (!core_->hosts.hold(header)) {
    if (name.empty()) return make_refusal(400, "bad Host header");
    if (!core_->host_told.exchange(true))
      log::warn(
          "refused a request for the host '{0}': if that is this server's name, start it "
          "with --allow-host {0}",
          name);
    return make_refusal(421, "this server is not known as '" + name +
                                 "'; if it should be, start it with --allow-host " + name);
  }
  if (!core_->certificate || stream().secure() || caller_.trusted) return {};
  HttpReply reply = make_refusal(308, "this server speaks TLS: ask https://");
  reply.headers["Location"] =
      "https://" + std::string(header) + std::string(view(request.target()));
  return reply;
}

bool Session::is_from_here(const Request& request) const {
  std::vector<std::string_view> origins;
  const auto range = request.equal_range(http::field::origin);
  for (auto it = range.first; it != range.second; ++it) origins.push_back(view(it->value()));
  return origin_allowed(origins, view(request[http::field::host]), core_->settings.allowed_origins);
}

bool Session::is_local(const Request& request) const {
  return is_from_this_machine(peer_, is_proxied(request), view(request[http::field::host]));
}

// Returns 200 if a body may be handed on, else the refusal.
HttpReply Session::judge_post(const Request& request) const {
  if (!is_from_here(request)) return make_refusal(403, "this origin may not post here");
  if (!is_json(view(request[http::field::content_type])))
    return make_refusal(415, "Content-Type is application/json");
  return {};
}

// Returns 101 if a WebSocket may be opened, else the refusal.
HttpReply Session::judge_upgrade(const HttpQuestion& question, const Request& request) {
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

  if (!is_from_here(request)) {
    log::debug("session {}: WebSocket from foreign origin refused", name_);
    return make_refusal(403, "this origin may not open WebSockets here");
  }
  const auto offers = request.equal_range(http::field::sec_websocket_protocol);
  bool offered = offers.first == offers.second;
  for (auto it = offers.first; it != offers.second; ++it)
    offered = offered || offers_protocol(view(it->value()), subprotocol);
  if (!offered) return make_refusal(400, "subprotocol is wellspring.v1");
  if (core_->doors.admit) admitted_ = core_->doors.admit(question);
  if (admitted_.refusal) return *admitted_.refusal;
  if (!caller_.trusted) {
    const Admission::Taken taken = core_->admission.open_websocket(caller_.address, seconds_now());
    counted_websocket_ = taken == Admission::Taken::yes;
    if (!counted_websocket_) return make_too_many(*core_, taken, "too many visits");
  }
  HttpReply reply;
  reply.status = 101;
  return reply;
}

// Returns whether the peer has closed its end of the connection, or the connection is broken.
bool Session::peer_has_left() {
  pollfd line{stream().socket().native_handle(), POLLRDHUP, 0};
  if (line.fd < 0) return true;  // the session was cut
  return poll(&line, 1, 0) > 0 && (line.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

// Gets the answer from a worker thread, or later from any; this coroutine looks meanwhile whether
// its peer still waits.
net::awaitable<HttpReply> Session::ask(HttpQuestion question) {
  auto reply = std::make_shared<HttpReply>();
  auto asker = std::make_shared<HttpAsker>([self = shared_from_this(), reply](HttpReply made) {
    *reply = std::move(made);
    net::post(self->ws_.get_executor(), [self] { self->answered_.raise(); });
  });
  const bool slow = core_->doors.slow && core_->doors.slow(question);
  const bool health =
      caller_.trusted && (question.path == "/healthz" || question.path == "/metrics");
  Workers& workers = health ? core_->health_workers : slow ? core_->slow_workers : core_->workers;
  const bool posted = workers.post([core = core_, question, asker](bool run) {
    const Doors& doors = core->doors;
    try {
      if (!run) asker->answer(make_refusal(503, "server stops"));
      else if (!doors.answer_later || !doors.answer_later(question, asker)) {
        HttpReply made = doors.answer(question);
        encode_reply(question, made);
        asker->answer(std::move(made));
      }
    } catch (const std::exception& e) {
      log::error("answer to {}: {}", question.path, e.what());
      asker->answer(make_refusal(500, "internal error"));
    }
  });
  if (!posted) {
    *reply = make_refusal(503, "too busy");
    reply->headers["Retry-After"] = "2";
    co_return std::move(*reply);
  }
  while (!co_await answered_.wait_for(look_at_peer)) {
    if (!peer_has_left()) continue;
    asker->leave();
    HttpReply nobody;
    nobody.status = 0;
    co_return nobody;
  }
  co_return std::move(*reply);
}

net::awaitable<void> Session::write_refusal(HttpQuestion question, int status, std::string message,
                                            std::string allowed) {
  HttpReply reply = make_refusal(status, message);
  if (!allowed.empty()) reply.headers["Allow"] = allowed;
  co_await write_reply(std::move(question), std::move(reply), 11, false);
  co_await linger();
}

// Puts the headers of any message except Content-Length.
template <class Message>
static void put_headers(const HttpReply& reply, bool secure, unsigned version, bool keep_alive,
                        Message& message) {
  message.version(version);
  message.result(unsigned(reply.status));
  message.set(http::field::server, "wellspring");
  message.set(http::field::date, http_date());
  for (const auto& [name, value] : security_headers(secure)) message.set(name, value);
  if (reply.status != 304 && reply.status != 204)
    message.set(http::field::content_type, reply.content_type);
  for (const auto& [name, value] : reply.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  if (reply.status == 426)
    message.set(http::field::connection, keep_alive ? "Upgrade" : "Upgrade, close");
}

// Writes a file in pieces. A file that ends early, or cannot be read, ends the connection: its
// length has been promised.
net::awaitable<error_code> Session::write_file(const FilePart& part,
                                               http::response<http::buffer_body>& message) {
  std::ifstream in(part.path, std::ios::binary);
  in.seekg(std::streamoff(part.begin));
  std::vector<char> piece(size_t(std::min<uint64_t>(part.size, file_piece_bytes)));
  http::response_serializer<http::buffer_body> serializer(message);
  for (uint64_t left = part.size;;) {
    const size_t count = size_t(std::min<uint64_t>(left, piece.size()));
    if (!in.read(piece.data(), std::streamsize(count))) {
      log::error("{} cannot be read", part.path);
      co_return net::error::make_error_code(net::error::misc_errors::eof);
    }
    left -= count;
    message.body() = {piece.data(), count, left > 0};
    stream().expires_after(http_write_timeout);
    error_code ec;
    co_await http::async_write(stream(), serializer, net::redirect_error(net::use_awaitable, ec));
    if (ec != http::error::need_buffer) co_return ec;  // everything is written, or writing failed
  }
}

// Writes a reply. True: the connection may be used again.
net::awaitable<bool> Session::write_reply(HttpQuestion question, HttpReply reply, unsigned version,
                                          bool keep_alive) {
  if (reply.status < 200 || reply.status > 599) {
    log::error("answer to {}: status {}", question.path, reply.status);
    reply = make_refusal(500, "internal error");
  }
  finish_reply(question, reply);
  const uint64_t body_bytes = reply.file ? reply.file->size : reply.body.size();
  const bool may_have_body = reply.status != 304 && reply.status != 204;
  stream().expires_after(http_write_timeout);
  error_code ec;
  if (!may_have_body || question.method == "HEAD") {
    http::response<http::empty_body> message;
    put_headers(reply, stream().secure(), version, keep_alive, message);
    if (may_have_body) message.content_length(body_bytes);
    co_await http::async_write(stream(), message, net::redirect_error(net::use_awaitable, ec));
  } else if (reply.file) {
    http::response<http::buffer_body> message;
    put_headers(reply, stream().secure(), version, keep_alive, message);
    message.content_length(body_bytes);
    ec = co_await write_file(*reply.file, message);
  } else {
    http::response<http::string_body> message;
    put_headers(reply, stream().secure(), version, keep_alive, message);
    message.content_length(body_bytes);
    message.body() = std::move(reply.body);
    co_await http::async_write(stream(), message, net::redirect_error(net::use_awaitable, ec));
  }
  log::debug("{} {} {} {} {}", caller_.name, question.method, question.path, reply.status,
             body_bytes);
  if (ec) fail(ec, "write reply");
  co_return !ec && keep_alive;
}

net::awaitable<void> Session::linger() {
  reading_ = true;  // stop() may close
  if (!stopping_) co_await stream().linger(1);
  else stream().close();
}

}  // namespace wellspring::stream
