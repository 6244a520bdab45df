// SPDX-License-Identifier: Apache-2.0
#include "stream/encoding.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "stream/header_text.h"
#include "wire/gzip.h"

namespace wellspring::stream {

// Thousandths of a qvalue: "0" or "1", then up to three digits after a point. Nothing: it is none.
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

// The weight of a coding's parameters, the text after its first semicolon.
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

}  // namespace wellspring::stream
