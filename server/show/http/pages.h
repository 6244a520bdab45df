// SPDX-License-Identifier: Apache-2.0
// The visitor's page as files in memory, read once at start: web/ is small, and a museum's disk may
// be slow.
#pragma once
#include <map>
#include <string>

#include "show/exhibit/exhibit.h"
#include "wire/http.h"

namespace wellspring::show {

struct PageFile {
  std::string content_type, body, etag;
  std::string gzip{};  // the text packed, if that is smaller than the body
};

// Key of the visitor's page as it is at /e/ID: what it names lies one folder above.
inline constexpr const char* exhibit_page = "/e/ID";

// Path as asked for ("/", "/kiosk", "/status", "/visit.js") to file. Throws LoadError when `folder`
// has no index.html. Files over 4 MiB and names starting with a dot are left out.
std::map<std::string, PageFile> load_pages(const std::string& folder);

std::string make_etag(const std::string& body);
// Writes a text as a part of an address's path or query (RFC 3986, section 2.3).
std::string escaped(const std::string& text);

// GET /api/v1/exhibits/ID/qr.svg: a code for a guest's phone, which opens the museum's public
// address there, with the story that the kiosk tells.

// The picture of a QR code (ISO/IEC 18004, error correction level M) as SVG: black on white, with
// the quiet zone of four modules. Throws std::length_error for more text than such a code holds.
std::string draw_qr_code(const std::string& text);

// 404 where the house has no public `address`, or there is no such story; else the code of
// ADDRESS/e/ID?story=STORY&lang=LANG, `story` and `lang` being optional.
HttpReply answer_qr(const Exhibit& exhibit, const std::string& address,
                    const HttpQuestion& question);

}  // namespace wellspring::show
