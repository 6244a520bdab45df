// SPDX-License-Identifier: Apache-2.0
#include "show/http/pages.h"

#include <cstring>
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <qrcodegen/qrcodegen.hpp>
#include <sstream>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/rng.h"
#include "wire/http.h"

namespace wellspring::show {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_page_bytes = 4 << 20;
const std::map<std::string, std::string> content_types = {
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".webmanifest", "application/manifest+json"},
    {".json", "application/json; charset=utf-8"},
    {".woff2", "font/woff2"}};

PageFile make_page(const std::string& content_type, std::string body) {
  PageFile page{content_type, std::move(body), {}};
  page.etag = make_etag(page.body);
  if (is_text(content_type)) page.gzip = gzip(page.body);
  return page;
}

}  // namespace

std::string make_etag(const std::string& body) {
  uint64_t hash = body.size();
  // Eight bytes at a time: stored tiles are many, and their tags a tenth of the work.
  for (size_t at = 0; at < body.size(); at += 8) {
    uint64_t word = 0;
    std::memcpy(&word, body.data() + at, std::min<size_t>(8, body.size() - at));
    hash = mix64(hash ^ word);
  }
  return fmt::format("\"{:016x}\"", hash);
}

std::string escaped(const std::string& text) {
  std::string out;
  for (unsigned char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.' || c == '~';
    out += plain ? std::string(1, char(c)) : fmt::format("%{:02X}", c);
  }
  return out;
}

std::map<std::string, PageFile> load_pages(const std::string& folder) {
  std::map<std::string, PageFile> pages;
  std::error_code ec;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ec)) {
    auto type = content_types.find(entry.path().extension().string());
    if (!entry.is_regular_file(ec) || type == content_types.end()) continue;
    if (entry.path().filename().string().starts_with('.') || entry.file_size(ec) > most_page_bytes)
      continue;
    pages["/" + fs::relative(entry.path(), folder, ec).generic_string()] =
        make_page(type->second, read_file(entry.path().string(), most_page_bytes));
  }
  if (!pages.contains("/index.html")) throw LoadError(folder, "", "holds no index.html");
  pages["/"] = pages["/index.html"];
  std::string inner = pages["/index.html"].body;
  const std::string head = "<head>";
  if (const size_t at = inner.find(head); at != std::string::npos)
    inner.insert(at + head.size(), "\n  <base href=\"../\">");
  pages[exhibit_page] = make_page(content_types.at(".html"), std::move(inner));
  if (auto icon = pages.find("/icon.svg"); icon != pages.end())  // asked for without being named
    pages.try_emplace("/favicon.ico", icon->second);
  for (const char* name : {"/kiosk", "/status", "/read", "/wall", "/collection"})
    if (auto page = pages.find(std::string(name) + ".html"); page != pages.end())
      pages[name] = page->second;
  return pages;
}

namespace {

constexpr int quiet_zone = 4;  // modules

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
