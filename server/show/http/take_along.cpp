// SPDX-License-Identifier: Apache-2.0
#include "show/http/take_along.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <qrcodegen/qrcodegen.hpp>

namespace wellspring::show {

namespace {

constexpr int quiet_zone = 4;  // modules

// As a part of an address's query (RFC 3986, section 2.3).
std::string escaped(const std::string& text) {
  std::string out;
  for (unsigned char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.' || c == '~';
    out += plain ? std::string(1, char(c)) : fmt::format("%{:02X}", c);
  }
  return out;
}

HttpReply not_found(const char* code, const std::string& message) {
  HttpReply reply;
  reply.status = 404;
  reply.body = nlohmann::json{{"error", {{"code", code}, {"message", message}}}}.dump(
      -1, ' ', false, nlohmann::json::error_handler_t::replace);
  return reply;
}

std::string value_of(const HttpQuestion& question, const char* name) {
  auto found = question.query.find(name);
  return found == question.query.end() ? "" : found->second;
}

}  // namespace

std::string draw_qr_code(const std::string& text) {
  const auto code = qrcodegen::QrCode::encodeText(text.c_str(), qrcodegen::QrCode::Ecc::MEDIUM);
  const int side = code.getSize() + 2 * quiet_zone;
  std::string path;
  for (int y = 0; y < code.getSize(); y++)
    for (int x = 0; x < code.getSize(); x++)
      if (code.getModule(x, y))
        path += fmt::format("M{},{}h1v1h-1z", x + quiet_zone, y + quiet_zone);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {0}\" "
      "shape-rendering=\"crispEdges\"><path fill=\"#fff\" d=\"M0,0h{0}v{0}h-{0}z\"/>"
      "<path d=\"{1}\"/></svg>\n",
      side, path);
}

HttpReply answer_qr(const Exhibit& exhibit, const std::string& address,
                    const HttpQuestion& question) {
  if (address.empty())
    return not_found("no_address", "the house file names no address that phones can open");
  const std::string story = value_of(question, "story"), lang = value_of(question, "lang");
  if (!story.empty() &&
      std::ranges::find(exhibit.stories, story, &StoryText::id) == exhibit.stories.end())
    return not_found("unknown_story", "there is no story '" + story + "'");
  std::string link = address + "/e/" + escaped(exhibit.id), sign = "?";
  for (const auto& [name, value] : {std::pair("story", story), std::pair("lang", lang)}) {
    if (value.empty()) continue;
    link += sign + name + "=" + escaped(value.substr(0, 100));
    sign = "&";
  }
  HttpReply reply;
  reply.content_type = "image/svg+xml";
  reply.headers["Cache-Control"] = "public, max-age=60";
  reply.body = draw_qr_code(link);
  return reply;
}

}  // namespace wellspring::show
