// SPDX-License-Identifier: Apache-2.0
// The visitor's page as files in memory, read once at start: web/ is small, and a museum's disk may
// be slow.
#pragma once
#include <map>
#include <string>

namespace wellspring::show {

struct PageFile {
  std::string content_type, body, etag;
  std::string gzip{};  // of text, where that is smaller than the body
};

// Key of the visitor's page as it is at /e/ID: what it names lies one folder above.
inline constexpr const char* exhibit_page = "/e/ID";

// Path as asked for ("/", "/kiosk", "/status", "/visit.js") to file. Throws LoadError when `folder`
// has no index.html. Files over 4 MiB and names starting with a dot are left out.
std::map<std::string, PageFile> load_pages(const std::string& folder);

std::string make_etag(const std::string& body);

}  // namespace wellspring::show
