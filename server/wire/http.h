// SPDX-License-Identifier: Apache-2.0
// A question over HTTP and its reply, free of any socket library. `show/answer` makes replies with
// pure functions; `stream` carries them.
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
  // Headers of those names.
  std::string if_none_match, range, if_range, accept, accept_encoding, authorization;
  std::string body;     // of a POST: what was posted
  bool local = false;   // from this machine itself, and through no proxy (stream/target.h)
  std::string address;  // of who asks, without its port
};

// Bytes of a file on disk.
struct FilePart {
  std::string path;
  uint64_t begin = 0, size = 0;
};

struct HttpReply {
  int status = 200;
  std::string content_type = "application/json; charset=utf-8";
  std::string body;
  std::string gzip;              // the body as gzip, where that is kept; else it is made
  std::optional<FilePart> file;  // instead of `body`, and never held in memory as a whole
  std::map<std::string, std::string> headers;  // Cache-Control, ETag, Retry-After, ...
};

// Whether a WebSocket may be opened, and who its peer is by what it has shown.
struct UpgradeAnswer {
  std::optional<HttpReply> refusal;  // empty: it may
  std::string kiosk{};               // Link::kiosk
};

// Who waits for the answer to a question. Any thread.
class HttpAsker {
 public:
  explicit HttpAsker(std::function<void(HttpReply)> take) : take_(std::move(take)) {}
  void answer(HttpReply reply) {  // the first counts
    if (!answered_.exchange(true)) take_(std::move(reply));
  }
  void leave() { gone_ = true; }
  bool gone() const { return gone_; }  // nobody waits any more

 private:
  const std::function<void(HttpReply)> take_;
  std::atomic<bool> answered_{false}, gone_{false};
};

// Text as gzip (RFC 1952), as it goes over HTTP.

// Whether gzip makes a body of this Content-Type smaller: pictures, sound and films are packed.
bool is_text(std::string_view content_type);

// The same text gives the same bytes. Empty where they would not be fewer than the text's.
std::string gzip(std::string_view text);

}  // namespace wellspring::wire
