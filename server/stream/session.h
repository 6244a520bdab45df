// SPDX-License-Identifier: Apache-2.0
// Runs one connection from accept to end, as a coroutine on a strand of its own: HTTP requests one
// after the other (session_http.cpp) and, after an upgrade, a WebSocket (session_websocket.cpp:
// this coroutine reads, a second one writes). Only for the .cpp files of this folder (heavy).
#pragma once
#include <chrono>
#include <deque>
#include <memory>
#include <string>

#include "base/clock.h"
#include "stream/asio.h"
#include "stream/core.h"
#include "stream/frame_counter.h"
#include "stream/transport.h"
#include "wire/http.h"
#include "wire/link.h"

namespace wellspring::stream {

inline constexpr size_t max_header_bytes = 16 * 1024;
inline constexpr size_t max_body_bytes = 64 * 1024;
inline constexpr size_t max_posted_bytes = 16 * 1024;
inline constexpr double http_write_timeout = 30;        // seconds for a reply, or a piece of a file
inline constexpr size_t file_piece_bytes = 256 * 1024;  // bytes in memory at a time
inline constexpr double max_frames_a_second = 400;      // frames of all kinds of a WebSocket
inline constexpr double max_bytes_a_second = 1 << 20;   // bytes of a WebSocket
// A page sends no more than this: an input, an acknowledgement and a pong for each picture of a
// display of 60 Hz, and some. Peers that send more are closed if all together send too much.
inline constexpr double modest_frames_a_second = 250, modest_bytes_a_second = 100e3;
inline constexpr double burst_seconds = 2;
inline constexpr double flood_linger = 1;  // seconds for a closed peer to read why

// Stale pictures must not pile up in the kernel, where newest-wins cannot reach them. A send buffer
// of 256 KiB holds one large or two usual pictures of 1280x720 and still fills 40 Mbit/s at 50 ms;
// of that, no more than 64 KiB may be waiting unsent (TCP_NOTSENT_LOWAT), the rest is on its way.
// It is also all the memory that a visitor who stopped reading can hold, besides the one picture
// being written.
inline constexpr int send_buffer_bytes = 256 * 1024;
inline constexpr int unsent_bytes = 64 * 1024;

// A ping follows each picture and larger text, and now and then a small one, so that its answer
// tells when that arrived. A peer is sent at most this many pings without an answer.
inline constexpr size_t most_pings = 16, pinged_bytes = 2000;
inline constexpr double ping_interval = 1;  // seconds

using Request = http::request<http::string_body>;

// Lets one coroutine wait for others of the same strand; a raise before the wait is not lost.
class Signal {
 public:
  explicit Signal(const net::any_io_executor& strand) : timer_(strand) {}
  void raise();
  net::awaitable<void> wait();
  net::awaitable<bool> wait_for(std::chrono::milliseconds limit);  // false: it was not raised

 private:
  net::steady_timer timer_;
  bool raised_ = false;
};

// Holds the client of a request: the peer, or the one that a proxy names.
struct Caller {
  Address address;
  bool trusted = false;
  std::string name;  // for the log
};

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(std::shared_ptr<Core> core, tcp::socket socket, uint64_t id, const tcp::endpoint& remote);
  ~Session();
  void start();
  void start_refusal(int status);  // 503 or 429, whatever the peer asks
  Standing standing() const;       // standing of the peer
  const Address& address() const { return address_; }
  void set_reserved() { reserved_ = true; }  // its place belongs to the reserve for trusted callers
  // Ends the session, from any thread. Politely: the answer being made is still written, a
  // WebSocket closed with 1001. Else the socket is closed at once.
  void stop(bool politely);
  void drop();  // ends it to make place for another; from any thread

 private:
  template <class Work>
  void spawn(Work work);
  net::awaitable<void> run();
  net::awaitable<void> refuse(int status);
  net::awaitable<bool> start_tls();
  void cut(const char* why);

  // session_http.cpp
  net::awaitable<void> serve_http();  // returns at the end or with upgrade_ set
  net::awaitable<int> read_request(Request& request);
  net::awaitable<void> write_refusal(HttpQuestion question, int status, std::string message,
                                     std::string allowed = "");
  net::awaitable<HttpReply> ask(HttpQuestion question);  // status 0: the peer has gone
  bool peer_has_left();
  net::awaitable<bool> write_reply(HttpQuestion question, HttpReply reply, unsigned version,
                                   bool keep_alive);
  net::awaitable<error_code> write_file(const FilePart& part,
                                        http::response<http::buffer_body>& message);
  net::awaitable<void> linger();
  std::optional<Caller> find_caller(const Request& request) const;
  HttpReply judge_caller(const Request& request);  // 200, or the refusal; sets caller_
  HttpReply judge_host(const Request& request) const;
  bool is_from_here(const Request& request) const;  // see origin_allowed() in target.h
  bool is_local(const Request& request) const;      // see is_from_this_machine() in target.h
  HttpReply judge_post(const Request& request) const;
  HttpReply judge_upgrade(const HttpQuestion& question, const Request& request);

  // session_websocket.cpp
  net::awaitable<void> serve_websocket();
  net::awaitable<bool> accept_websocket();
  net::awaitable<bool> read_messages();
  net::awaitable<void> write_messages();
  net::awaitable<error_code> ping(Delivery behind);
  bool take_pong(beast::string_view payload);
  void want_close(websocket::close_code code, std::string reason);
  void hear(std::string text);
  bool count_input(const WireInput& input);
  void start_first_deadline();
  void start_deadline();
  void end_deadline();
  void wake_writer();  // from any thread

  Transport& stream() { return ws_.next_layer(); }
  const Transport& stream() const { return ws_.next_layer(); }

  const std::shared_ptr<Core> core_;
  const uint64_t id_;
  const std::string peer_;
  const Address address_;
  const std::string name_;  // for the log, which does not keep strangers' addresses
  bool reserved_ = false, refused_ = false;
  Caller caller_;                           // caller of the current request, or of the WebSocket
  websocket::stream<Transport, false> ws_;  // false: no permessage-deflate, JPEG is packed
  beast::flat_buffer buffer_;
  bool stopping_ = false;  // stop() was called
  bool reading_ = false;   // HTTP: waiting for a request
  Signal answered_;

  std::unique_ptr<Request> upgrade_;  // the request that asked for a WebSocket
  bool counted_websocket_ = false;    // counted for the caller's address
  UpgradeAnswer admitted_;            // the show's answer to that request
  std::shared_ptr<Link> link_;
  bool joined_ = false;   // a first message came
  bool flooded_ = false;  // too many messages came
  Signal writable_, writer_ended_;
  std::atomic<bool> wake_posted_{false};
  // Pings without an answer yet; the first is ping number first_ping_.
  std::deque<Delivery> pinged_;
  uint64_t first_ping_ = 0;
  double ping_at_ = -1e9;
  net::steady_timer deadline_, first_deadline_, flood_deadline_;
  uint64_t deadline_number_ = 0;
  websocket::close_reason close_reason_{websocket::close_code::none};
  bool ended_ = false;
  FrameCounter frame_counter_;
  RateBound frames_{max_frames_a_second, max_frames_a_second* burst_seconds};
  RateBound bytes_{max_bytes_a_second, max_bytes_a_second* burst_seconds};
  RateBound modest_{modest_frames_a_second, modest_frames_a_second* burst_seconds};
  RateBound modest_bytes_{modest_bytes_a_second, modest_bytes_a_second* burst_seconds};
};

}  // namespace wellspring::stream
