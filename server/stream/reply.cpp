// SPDX-License-Identifier: Apache-2.0
#include "stream/reply.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "base/log.h"
#include "wire/http.h"

namespace wellspring::stream {

// Returns thousandths of a qvalue: "0" or "1", then up to three digits after a point. Nothing: the
// text is no qvalue.
static std::optional<int> read_weight(std::string_view text) {
  if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1')) return std::nullopt;
  if (text.size() > 1 && text[1] != '.') return std::nullopt;
  int weight = 1000 * (text[0] - '0'), place = 100;
  for (char c : text.substr(std::min<size_t>(2, text.size()))) {
    if (c < '0' || c > '9') return std::nullopt;
    weight += place * (c - '0');
    place /= 10;
  }
  return weight <= 1000 ? std::optional(weight) : std::nullopt;
}

// Returns the weight in a coding's parameters, the text after its first semicolon.
static std::optional<int> read_parameters(std::string_view text) {
  const std::string parameter = lower(trimmed(text));
  return parameter.starts_with("q=") ? read_weight(std::string_view(parameter).substr(2))
                                     : std::nullopt;
}

bool wants_gzip(const std::string& accept_encoding) {
  std::optional<int> packed, plain, any;
  for (std::string_view left = accept_encoding; !left.empty();) {
    const std::string_view part = take_item(left);
    const size_t end = part.find(';');
    const std::string name = lower(trimmed(part.substr(0, end)));
    const auto weight = end == part.npos ? 1000 : read_parameters(part.substr(end + 1));
    if (!weight) continue;
    if (name == "gzip" || name == "x-gzip") packed = std::max(packed.value_or(0), *weight);
    if (name == "identity") plain = weight;
    if (name == "*") any = weight;
  }
  const int gzip_weight = packed ? *packed : any.value_or(0);
  return gzip_weight > 0 && gzip_weight >= plain.value_or(0);
}

void encode_reply(const HttpQuestion& question, HttpReply& reply) {
  if (reply.file || !is_text(reply.content_type)) return;
  if (reply.gzip.empty() && reply.body.size() < least_packed_bytes) return;
  std::string& vary = reply.headers["Vary"];
  vary += vary.empty() ? "Accept-Encoding" : ", Accept-Encoding";
  if (!wants_gzip(question.accept_encoding)) return;
  if (reply.gzip.empty()) reply.gzip = gzip(reply.body);
  if (reply.gzip.empty()) return;
  reply.body = std::move(reply.gzip);
  reply.headers["Content-Encoding"] = "gzip";
  if (const auto etag = reply.headers.find("ETag");
      etag != reply.headers.end() && etag->second.ends_with('"'))
    etag->second.insert(etag->second.size() - 1, "-gzip");
}

// Reads a number of digits and nothing else.
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

std::span<const std::pair<const char*, const char*>> security_headers(bool secure) {
  static constexpr std::pair<const char*, const char*> headers[] = {
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
       "connect-src 'self'; media-src 'self' blob:; worker-src 'self' blob:; font-src 'self'; "
       "base-uri 'self'; frame-ancestors 'self'; form-action 'none'"},
      {"Permissions-Policy", "camera=(), microphone=()"},
      {"X-Frame-Options", "SAMEORIGIN"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-site"},
      {"Strict-Transport-Security", "max-age=31536000"},  // the last: with TLS alone
  };
  return std::span(headers).first(std::size(headers) - (secure ? 0 : 1));
}

HttpReply make_refusal(int status, const std::string& message) {
  HttpReply reply;
  reply.status = status;
  reply.body = nlohmann::json{{"error", {{"status", status}, {"message", message}}}}.dump() + "\n";
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

bool etag_matches(const std::string& if_none_match, const std::string& etag) {
  const auto strong = [](std::string_view tag) {
    return tag.starts_with("W/") ? tag.substr(2) : tag;
  };
  std::string_view list = if_none_match;
  if (list == "*") return true;
  while (!list.empty()) {
    const size_t begin = list.find_first_not_of(" \t,");
    if (begin == list.npos) return false;
    list.remove_prefix(begin);
    // The quoted part may hold commas: it ends at its closing quote.
    const size_t open = list.find('"');
    const size_t close = open == list.npos ? list.npos : list.find('"', open + 1);
    if (close == list.npos) return false;
    if (strong(list.substr(0, close + 1)) == strong(etag)) return true;
    list.remove_prefix(close + 1);
  }
  return false;
}

static bool fits_a_line(std::string_view text) {
  return std::ranges::all_of(text,
                             [](unsigned char c) { return (c >= 0x20 && c != 0x7f) || c == '\t'; });
}

void finish_reply(const HttpQuestion& question, HttpReply& reply) {
  if (const auto etag = reply.headers.find("ETag");
      etag != reply.headers.end() && reply.status == 200 && !question.if_none_match.empty() &&
      etag_matches(question.if_none_match, etag->second))
    reply.status = 304;
  if (reply.status == 304) {
    reply.body.clear();
    reply.file.reset();
    reply.headers.erase("Content-Encoding");
  }
  if (reply.status == 200 && reply.file) narrow_to_range(question, reply);
  reply.headers.try_emplace("Cache-Control", "no-cache");
  std::erase_if(reply.headers, [&](const auto& header) {
    const bool bad = header.first.empty() || !fits_a_line(header.first) ||
                     !fits_a_line(header.second) ||
                     header.first.find_first_of(": ") != std::string::npos;
    if (bad) log::warn("reply to {}: header that fits no line dropped", question.path);
    return bad;
  });
  if (!fits_a_line(reply.content_type)) reply.content_type = "application/octet-stream";
}

}  // namespace wellspring::stream
