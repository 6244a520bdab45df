// SPDX-License-Identifier: Apache-2.0
// Defines a question over HTTP and its reply, free of any socket library. `show/answer` makes
// replies with pure functions; `stream` carries them.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace wellspring::wire {

struct HttpQuestion {
  std::string method;  // "GET", "HEAD", ...
  std::string path;    // percent-decoded, starts with '/', holds no "..", no NUL, no '\\'
  std::map<std::string, std::string> query;  // percent-decoded; the last of equal names
  // The headers of these names.
  std::string if_none_match, range, if_range, accept, accept_encoding, authorization;
  std::string body;     // body of a POST
  bool local = false;   // comes from this machine itself, and through no proxy (stream/target.h)
  std::string address;  // client's address, without port
  std::string site;     // this server as the client names it: "https://museum.example"; or empty
};

// Names bytes of a file on disk.
struct FilePart {
  std::string path;
  uint64_t begin = 0, size = 0;
};

struct HttpReply {
  int status = 200;
  std::string content_type = "application/json; charset=utf-8";
  std::string body;
  std::string gzip;              // the body as gzip, if that is kept; else it is made
  std::optional<FilePart> file;  // sent instead of `body`, and never held in memory as a whole
  std::map<std::string, std::string> headers;  // Cache-Control, ETag, Retry-After, ...
};

// Says whether a WebSocket may be opened, and for which kiosk its peer has a token.
struct UpgradeAnswer {
  std::optional<HttpReply> refusal;  // empty: it may be opened
  std::string kiosk{};               // Link::kiosk
};

// Takes the answer to a question for the client that waits. Any thread.
class HttpAsker {
 public:
  explicit HttpAsker(std::function<void(HttpReply)> take) : take_(std::move(take)) {}
  void answer(HttpReply reply) {  // only the first answer counts
    if (!answered_.exchange(true)) take_(std::move(reply));
  }
  void leave() { gone_ = true; }
  bool gone() const { return gone_; }  // nobody waits any more

 private:
  const std::function<void(HttpReply)> take_;
  std::atomic<bool> answered_{false}, gone_{false};
};

// Packs text as gzip (RFC 1952), as it goes over HTTP.

// Returns whether gzip makes a body of this Content-Type smaller: pictures, sound and films are
// packed already.
bool is_text(std::string_view content_type);

// Packs a text; the same text gives the same bytes. Empty if they would not be fewer than the
// text's.
std::string gzip(std::string_view text);

}  // namespace wellspring::wire
