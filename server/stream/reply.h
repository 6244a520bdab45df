// SPDX-License-Identifier: Apache-2.0
// Adds the headers that every reply carries, and makes small replies of our own.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/layers.h"
#include "wire/http.h"

namespace wellspring::stream {

// Reads words of headers.

// Turns ASCII letters into small ones.
inline std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c += 'a' - 'A';
  return out;
}

// Returns the text without spaces and tabs around it.
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

// Sends replies as gzip to clients that accept it: RFC 9110, sections 8.4 and 12.5.3.

// Shorter texts that are made for one reply are sent as they are; kept ones (HttpReply::gzip) have
// no least size.
inline constexpr size_t least_packed_bytes = 1000;

// Returns whether Accept-Encoding allows gzip, and prefers plain text no more than gzip. A part of
// the header that is no coding with a weight allows nothing.
bool wants_gzip(const std::string& accept_encoding);

// Makes a text's body gzip, with an ETag of its own, if the client wants that and it is smaller.
// Vary says for both which header chose them. Takes as long as zlib does, about 25 ms a MB: not for
// threads that others wait for.
void encode_reply(const HttpQuestion& question, HttpReply& reply);

// Sends parts of files, as players of films ask for them: RFC 9110, section 14.

struct ByteRange {
  uint64_t begin = 0, size = 0;  // size 0: outside of the file
};
// Returns the range that the header's value "bytes=FIRST-LAST", "bytes=FIRST-" or "bytes=-LENGTH"
// means in a file of `size` bytes. Nothing: the value is none of these and is to be ignored; so are
// several ranges, which a server may choose.
std::optional<ByteRange> read_range(const std::string& value, uint64_t size);

// Makes a reply of 200 with a file one of 206 with the part asked for, or 416 if there is no such
// part. Leaves it as it is if the client wants no range, or has a part of another version
// (If-Range).
void narrow_to_range(const HttpQuestion& question, HttpReply& reply);

// Returns headers of every reply, WebSocket handshakes included. They say what the page may load
// (all from here), that types are not guessed, that no foreign page frames ours, shares its window
// or embeds our files, and that no page gets the camera or microphone; over TLS, that browsers stay
// with TLS.
std::span<const std::pair<const char*, const char*>> security_headers(bool secure);

// Makes {"error": {"status":.., "message":..}}.
HttpReply make_refusal(int status, const std::string& message);

// Makes a good reply whose ETag the client already has a 304 without body, narrows a reply of a
// file to the range asked for (206, or 416), sets Cache-Control: no-cache if it is not set, and
// drops headers that no header line can hold.
void finish_reply(const HttpQuestion& question, HttpReply& reply);

// Returns whether If-None-Match (RFC 9110 section 13.1.2) matches: "*", or a list with an equal tag
// (weak comparison).
bool etag_matches(const std::string& if_none_match, const std::string& etag);

}  // namespace wellspring::stream
