// SPDX-License-Identifier: Apache-2.0
#include "show/http/pages.h"

#include <filesystem>
#include <fstream>
#include <fmt/core.h>
#include <sstream>

#include "base/load_error.h"
#include "base/rng.h"
#include "wire/gzip.h"

namespace wellspring::show {

namespace fs = std::filesystem;

namespace {

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
  for (unsigned char c : body) hash = mix64(hash ^ c);
  return fmt::format("\"{:016x}\"", hash);
}

std::map<std::string, PageFile> load_pages(const std::string& folder) {
  std::map<std::string, PageFile> pages;
  std::error_code ec;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ec)) {
    auto type = content_types.find(entry.path().extension().string());
    if (!entry.is_regular_file(ec) || type == content_types.end()) continue;
    if (entry.path().filename().string().starts_with('.') || entry.file_size(ec) > (4u << 20))
      continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::stringstream body;
    body << in.rdbuf();
    pages["/" + fs::relative(entry.path(), folder, ec).generic_string()] =
        make_page(type->second, body.str());
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
  for (const char* name : {"/kiosk", "/status", "/read"})
    if (auto page = pages.find(std::string(name) + ".html"); page != pages.end())
      pages[name] = page->second;
  return pages;
}

}  // namespace wellspring::show
