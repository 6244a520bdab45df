// SPDX-License-Identifier: Apache-2.0
#include "stream/range.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace wellspring::stream {

// Digits and nothing else.
static std::optional<uint64_t> read_number(std::string_view text) {
  uint64_t value = 0;
  auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || ec != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<ByteRange> read_range(const std::string& value, uint64_t size) {
  std::string_view text = value;
  const size_t dash = text.find('-');
  if (!text.starts_with("bytes=") || dash == text.npos) return std::nullopt;
  const std::string_view first = text.substr(6, dash - 6), last = text.substr(dash + 1);
  const auto begin = read_number(first), end = read_number(last);
  if ((!first.empty() && !begin) || (!last.empty() && !end) || (!begin && !end))
    return std::nullopt;
  if (!begin) return ByteRange{size - std::min(*end, size), std::min(*end, size)};
  if (end && *end < *begin) return std::nullopt;
  if (*begin >= size) return ByteRange{};
  return ByteRange{*begin, end ? std::min(*end - *begin, size - *begin - 1) + 1 : size - *begin};
}

void narrow_to_range(const HttpQuestion& question, HttpReply& reply) {
  const uint64_t all = reply.file->size;
  reply.headers["Accept-Ranges"] = "bytes";
  if (question.range.empty() || question.method != "GET") return;
  if (const auto etag = reply.headers.find("ETag");
      !question.if_range.empty() &&
      (etag == reply.headers.end() || etag->second != question.if_range))
    return;
  const auto range = read_range(question.range, all);
  if (!range) return;
  if (range->size == 0) {
    reply.status = 416;
    reply.file.reset();
    reply.content_type = "text/plain; charset=utf-8";
    reply.body = "the file has no such part\n";
    reply.headers["Content-Range"] = "bytes */" + std::to_string(all);
    return;
  }
  reply.status = 206;
  reply.headers["Content-Range"] = "bytes " + std::to_string(range->begin) + "-" +
                                   std::to_string(range->begin + range->size - 1) + "/" +
                                   std::to_string(all);
  reply.file->begin += range->begin;
  reply.file->size = range->size;
}

}  // namespace wellspring::stream
