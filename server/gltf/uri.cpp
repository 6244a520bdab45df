// SPDX-License-Identifier: Apache-2.0
#include "gltf/uri.h"

#include <cctype>

#include "gltf/find_file.h"
#include "base/load_error.h"
#include "base/near_name.h"
#include "gltf/limits.h"

namespace wellspring::gltf {
namespace {

namespace fs = std::filesystem;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decode(const File& file, const std::string& where, std::string_view uri) {
  std::string decoded;
  decoded.reserve(uri.size());
  for (size_t i = 0; i < uri.size(); i++) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0)
      refuse(file, where, "bad percent escape in URI (a percent sign itself is written %25)");
    decoded += char(high * 16 + low);
    i += 2;
  }
  return decoded;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// RFC 3986 section 3.1, in lower case; empty: a relative reference.
std::string scheme_of(std::string_view uri) {
  const size_t colon = uri.find(':');
  if (colon == std::string_view::npos || uri.find_first_of("/?#") < colon) return "";
  return lower_case(uri.substr(0, colon));
}

Bytes decode_base64(const File& file, const std::string& where, std::string_view text) {
  auto value = [](char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
  };
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() * 3 / 4);
  uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    int v = value(c);
    if (v < 0) refuse(file, where, "data URI has a character that is not base64");
    bits = bits << 6 | uint32_t(v);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(uint8_t(bits >> count));
    }
  }
  return bytes;
}

// Without ";base64" the bytes are percent-encoded; base64 may be, too.
Bytes decode_data_uri(const File& file, const std::string& where, std::string_view uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) refuse(file, where, "data URI without a comma");
  const std::string_view body = uri.substr(comma + 1);
  if (!lower_case(uri.substr(0, comma)).ends_with(";base64")) {
    const std::string decoded = percent_decode(file, where, body);
    return Bytes(decoded.begin(), decoded.end());
  }
  if (body.find('%') == std::string_view::npos) return decode_base64(file, where, body);
  return decode_base64(file, where, percent_decode(file, where, body));
}

std::string quoted(const std::string& uri) { return "\"" + uri.substr(0, 200) + "\""; }

// The path from the package's folder that a URI means, without "." and "..".
fs::path resolve(const File& file, const std::string& where, const std::string& uri) {
  auto refuse_it = [&](const std::string& why) { refuse(file, where, quoted(uri) + " " + why); };
  if (const std::string scheme = scheme_of(uri); !scheme.empty())
    refuse_it("is a \"" + scheme.substr(0, 20) +
              ":\" URI; only data: and files of the package are read");
  const std::string path =
      percent_decode(file, where, std::string_view(uri).substr(0, uri.find_first_of("?#")));
  if (path.empty()) refuse_it("names no file");
  if (path.find('\0') != std::string::npos) refuse_it("has a byte that is 0");
  if (path.find('\\') != std::string::npos)
    refuse_it("has a backslash: folders are parted by \"/\"");
  if (path.front() == '/')
    refuse_it("does not lie inside the package: paths begin at the glTF file's own folder");
  std::vector<std::string> parts;
  for (const fs::path& part : file.folder.lexically_relative(file.package))
    if (part != "." && !part.empty()) parts.push_back(part.string());
  for (const fs::path& part : fs::path(path)) {
    if (part == "." || part.empty()) continue;
    if (part != "..") {
      parts.push_back(part.string());
      continue;
    }
    if (parts.empty())
      refuse_it("does not lie inside the package: it leads out of " +
                quoted(file.package.filename().string()));
    parts.pop_back();
  }
  fs::path resolved;
  for (const std::string& part : parts) resolved /= part;
  return resolved;
}

}  // namespace

bool is_data_uri(const std::string& uri) { return scheme_of(uri) == "data"; }

std::optional<fs::path> find_uri(const File& file, const std::string& where,
                                 const std::string& uri) {
  const std::optional<fs::path> found = find_file(file.package, resolve(file, where, uri));
  if (!found) return {};
  // Links are followed and judged by where they lead.
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(*found, error);
  if (error || !lies_in(canonical, file.package))
    refuse(file, where, quoted(uri) + " does not lie inside the package: it is a link out of it");
  return canonical;
}

std::optional<Bytes> read_uri(const File& file, const std::string& where, const std::string& uri) {
  if (is_data_uri(uri)) return decode_data_uri(file, where, uri);
  const std::optional<fs::path> path = find_uri(file, where, uri);
  if (!path) return {};
  try {
    return read_bytes(path->string(), file_bytes_limit);
  } catch (const LoadError& problem) {
    refuse(file, where, "file " + quoted(uri) + ": " + problem.what_);
  }
}

std::string no_such_file(const File& file, const std::string& where, const std::string& uri) {
  const std::string tried = resolve(file, where, uri).string();
  std::string told = "no such file: " + quoted(uri);
  if (tried != uri) told += ", that is " + quoted(tried) + " in the package";
  if (uri.find_first_of("?#") != std::string::npos)
    told += " (\"?\" and \"#\" of a name are written %3F and %23)";
  return told + did_you_mean(tried, list_files(file.package));
}

}  // namespace wellspring::gltf
