// SPDX-License-Identifier: Apache-2.0
#include "stream/reply.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/log.h"
#include "stream/range.h"

namespace wellspring::stream {

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
