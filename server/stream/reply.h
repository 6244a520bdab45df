// SPDX-License-Identifier: Apache-2.0
// What every reply carries besides what the show said, and small replies of our own.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

// Words of headers.

// Small letters of ASCII.
inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  return out;
}

// Without spaces and tabs around it.
inline std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

// Takes the next item off the front of a list that commas separate.
inline std::string_view take_item(std::string_view& list) {
  const std::string_view item = list.substr(0, list.find(','));
  list.remove_prefix(item.size() < list.size() ? item.size() + 1 : item.size());
  return trimmed(item);
}

// Replies as gzip, for those who take them so: RFC 9110, sections 8.4 and 12.5.3.

// Shorter texts of the moment are sent as they are; kept ones (HttpReply::gzip) have no least size.
inline constexpr size_t least_packed_bytes = 1000;

// Whether Accept-Encoding allows gzip, and likes it no less than the text as it is. A part of the
// header that is no coding with a weight allows nothing.
bool wants_gzip(const std::string& accept_encoding);

// Makes the body of text gzip, with an ETag of its own, where the asker wants that and it is
// smaller. Vary says of both which header they were chosen by. Takes as long as zlib does, about
// 25 ms a MB: not for threads that others wait for.
void encode_reply(const HttpQuestion& question, HttpReply& reply);

// Parts of files, as players of films ask for them: RFC 9110, section 14.

struct ByteRange {
  uint64_t begin = 0, size = 0;  // size 0: outside of the file
};
// The range that the header's value "bytes=FIRST-LAST", "bytes=FIRST-" or "bytes=-LENGTH" means in
// a file of `size` bytes. Nothing: to be ignored, because it is none of these; several ranges are
// not given, which a server may choose.
std::optional<ByteRange> read_range(const std::string& value, uint64_t size);

// Makes a reply of 200 with a file one of 206 with the part asked for, or 416 where there is none.
// Stays as it is where the asker wants no range, or has a part of another version (If-Range).
void narrow_to_range(const HttpQuestion& question, HttpReply& reply);

// Headers of every reply, WebSocket handshakes included: what the page may load (all from here),
// that types are not guessed, that no page of others frames ours, shares its window
// or embeds what is here, that no page gets the camera or microphone; over TLS, that it stays at
// that.
std::span<const std::pair<const char*, const char*>> security_headers(bool secure);

// {"error": {"status":.., "message":..}}
HttpReply make_refusal(int status, const std::string& message);

// Makes a good reply whose ETag the asker already has a 304 without body, narrows one of a file to
// the range asked for (206, or 416), sets Cache-Control: no-cache where nothing is said, and drops
// headers that no header line can hold.
void finish_reply(const HttpQuestion& question, HttpReply& reply);

// If-None-Match as RFC 9110 section 13.1.2: "*", or a list with an equal tag (weak comparison).
bool etag_matches(const std::string& if_none_match, const std::string& etag);

}  // namespace wellspring::stream
