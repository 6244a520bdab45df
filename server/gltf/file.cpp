// SPDX-License-Identifier: Apache-2.0
// Reads a file from its path to JSON and bytes: the GLB container (glTF 2.0 section 4), nesting
// limits, the package.
#include "gltf/file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

#include "base/load_error.h"
#include "base/read_file.h"
#include "base/unicode.h"

namespace wellspring::gltf {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_entries = 20'000;  // most entries of a folder that are compared

bool is_ascii(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
}

// Finds the entry of a folder whose name is the same by Unicode; of several the first.
std::optional<fs::path> find_alike(const fs::path& folder, const std::string& name) {
  if (is_ascii(name)) return {};
  const std::string wanted = nfc(name);
  std::optional<fs::path> found;
  std::error_code ec;
  size_t looked_at = 0;
  for (fs::directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    if (++looked_at > most_entries) break;
    const fs::path entry = at->path();
    if (nfc(entry.filename().string()) == wanted && (!found || entry < *found)) found = entry;
  }
  return found;
}

}  // namespace

std::optional<fs::path> find_file(const fs::path& folder, const fs::path& relative) {
  fs::path path = folder;
  std::error_code ec;
  for (const fs::path& part : relative) {
    if (part.empty() || part == ".") continue;
    if (fs::exists(path / part, ec)) {
      path /= part;
      continue;
    }
    const std::optional<fs::path> alike = find_alike(path, part.string());
    if (!alike) return {};
    path = *alike;
  }
  return path;
}

std::vector<std::string> list_files(const fs::path& folder, size_t most) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::recursive_directory_iterator at(folder, ec), end; !ec && at != end; at.increment(ec)) {
    if (names.size() == most) break;
    if (at->is_regular_file(ec)) names.push_back(at->path().lexically_relative(folder).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

namespace {

namespace fs = std::filesystem;

constexpr int depth_limit = 100;
constexpr size_t warning_limit = 200;

uint32_t word(const Bytes& bytes, size_t offset) {
  return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 |
         uint32_t(bytes[offset + 2]) << 16 | uint32_t(bytes[offset + 3]) << 24;
}

// Checks the depth of nesting, as the JSON library copies and prints by recursion.
void check_depth(const File& file, const char* begin, const char* end) {
  int depth = 0;
  bool in_string = false;
  for (const char* p = begin; p < end; p++) {
    if (in_string) {
      if (*p == '\\') p++;
      else if (*p == '"') in_string = false;
    } else if (*p == '"') {
      in_string = true;
    } else if (*p == '[' || *p == '{') {
      if (++depth > depth_limit)
        refuse(file, "byte " + std::to_string(p - begin),
               "JSON nested deeper than " + std::to_string(depth_limit) + " levels");
    } else if (*p == ']' || *p == '}') {
      depth--;
    }
  }
}

void parse_json(File& file, const char* begin, const char* end) {
  if (begin == end) refuse(file, "", "the file is empty");
  if (end - begin > json_bytes_limit)
    refuse_beyond(file, "", json_bytes_limit, "bytes of JSON",
                  "put its data into a binary buffer: as .glb, or as .gltf with a .bin");
  check_depth(file, begin, end);
  if (end - begin >= 3 && std::memcmp(begin, "\xef\xbb\xbf", 3) == 0)
    warn(file, "byte 0", "the text starts with a byte order mark");
  try {
    file.root = json::parse(begin, end);
  } catch (const json::exception& error) {
    std::string reason =
        error.what();  // "[json.exception.parse_error.101] parse error at line ..."
    size_t bracket = reason.find("] ");
    if (bracket != std::string::npos) reason.erase(0, bracket + 2);
    const auto* syntax = dynamic_cast<const json::parse_error*>(&error);
    refuse(file, syntax ? "byte " + std::to_string(syntax->byte) : "",
           "not valid JSON: " + reason.substr(0, 200));
  }
}

// Splits a GLB and takes its bytes: the binary chunk's bytes stay, without a copy.
void split_glb(File& file, Bytes bytes) {
  if (bytes.size() < 20) refuse(file, "byte 0", "GLB header is cut short");
  if (word(bytes, 4) != 2)
    refuse(file, "byte 4", "GLB version " + std::to_string(word(bytes, 4)) + " is not 2");
  size_t length = word(bytes, 8);
  if (length > bytes.size())
    refuse(file, "byte 8",
           "GLB says it has " + std::to_string(length) + " bytes but the file ends at " +
               std::to_string(bytes.size()));
  if (length < bytes.size()) warn(file, "byte 8", "data after the end of the GLB is ignored");
  bool has_json = false;
  size_t binary_begin = 0, binary_end = 0;
  for (size_t offset = 12; offset < length;) {
    std::string where = "byte " + std::to_string(offset);
    if (length - offset < 8) refuse(file, where, "GLB chunk header is cut short");
    size_t size = word(bytes, offset);
    uint32_t kind = word(bytes, offset + 4);
    if (size > length - offset - 8) refuse(file, where, "GLB chunk reaches beyond the file");
    const char* data = reinterpret_cast<const char*>(bytes.data()) + offset + 8;
    if (kind == 0x4e4f534a && !has_json) {  // "JSON"
      parse_json(file, data, data + size);
      has_json = true;
    } else if (!has_json) {
      refuse(file, where, "the first GLB chunk is not JSON");
    } else if (kind == 0x004e4942 && !file.has_binary) {  // "BIN"
      binary_begin = offset + 8, binary_end = binary_begin + size;
      file.has_binary = true;
    } else {
      warn(file, where, "an unknown GLB chunk is ignored");
    }
    offset += 8 + size;
  }
  if (!has_json) refuse(file, "byte 12", "GLB has no JSON chunk");
  bytes.resize(binary_end);
  bytes.erase(bytes.begin(), bytes.begin() + std::ptrdiff_t(binary_begin));
  file.binary = std::move(bytes);
}

// Normalises names, which are compared with those of other files: exhibit.json, stories
// (base/unicode.h).
void normalise_names(File& file) {
  auto normalise = [](json& list) {
    for (json& object : list)
      if (auto name = object.find("name"); name != object.end())
        *name = nfc(name->get<std::string>());
  };
  for (const char* kind : {"animations", "cameras", "materials", "meshes", "nodes", "scenes"})
    if (auto list = file.root.find(kind); list != file.root.end()) normalise(*list);
  if (extension(file.root, "KHR_lights_punctual"))
    normalise(file.root["extensions"]["KHR_lights_punctual"]["lights"]);
}

}  // namespace

void refuse(const File& file, const std::string& where, const std::string& what) {
  throw LoadError(file.path, where, what);
}

void refuse_beyond(const File& file, const std::string& where, int64_t limit,
                   const std::string& of_what, const std::string& remedy) {
  refuse(file, where,
         "more than " + std::to_string(limit) + " " + of_what +
             ", which is the most that is read (docs/operation.md): " + remedy);
}

void warn(File& file, const std::string& where, const std::string& what) {
  if (file.warnings.size() >= warning_limit || !file.said.insert(what).second) return;
  file.warnings.push_back(where.empty() ? what : where + ": " + what);
}

File load_gltf(const std::string& path, const std::string& package,
               const std::set<std::string>& further) {
  File file;
  file.path = path;
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(fs::path(path), error);
  if (error) throw LoadError(path, "", "no such file");
  file.folder = canonical.parent_path();
  file.package = package.empty() ? file.folder : fs::weakly_canonical(fs::path(package), error);
  if (error) throw LoadError(path, "", "package folder \"" + package + "\" cannot be resolved");
  if (!file.package.has_filename()) file.package = file.package.parent_path();  // trailing slash
  Bytes bytes = read_file<Bytes>(path, file_bytes_limit);
  if (bytes.size() >= 4 && word(bytes, 0) == 0x46546c67) {  // "glTF"
    split_glb(file, std::move(bytes));
  } else {
    const char* data = reinterpret_cast<const char*>(bytes.data());
    parse_json(file, data, data + bytes.size());
  }
  bytes = Bytes();
  check_schema(file);
  normalise_names(file);
  check_extensions(file, further);
  file.buffers.resize(items(file.root, "buffers").size());
  file.buffer_ready.assign(file.buffers.size(), 0);
  check_layout(file);
  return file;
}

const json* find(const json& object, const char* key) {
  auto it = object.find(key);
  return it == object.end() ? nullptr : &*it;
}

const json& items(const json& object, const char* key) {
  static const json none = json::array();
  const json* found = find(object, key);
  return found ? *found : none;
}

const json* extension(const json& object, const char* name) {
  const json* all = find(object, "extensions");
  return all ? find(*all, name) : nullptr;
}

int64_t integer(const json& object, const char* key, int64_t otherwise) {
  const json* found = find(object, key);
  return found ? found->get<int64_t>() : otherwise;
}

double number(const json& object, const char* key, double otherwise) {
  const json* found = find(object, key);
  return found ? found->get<double>() : otherwise;
}

bool boolean(const json& object, const char* key, bool otherwise) {
  const json* found = find(object, key);
  return found ? found->get<bool>() : otherwise;
}

std::string text(const json& object, const char* key, const std::string& otherwise) {
  const json* found = find(object, key);
  return found ? found->get<std::string>() : otherwise;
}

std::string at(const std::string& where, size_t index) {
  return where + "/" + std::to_string(index);
}

std::string at(const std::string& where, const std::string& key) {
  std::string escaped = where + "/";
  for (char c : key.substr(0, 100)) {
    if (c == '~') escaped += "~0";
    else if (c == '/') escaped += "~1";
    else escaped += c;
  }
  return escaped;
}

float to_float(double value) { return float(std::fmin(std::fmax(value, -1e30), 1e30)); }

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

// Returns the scheme (RFC 3986 section 3.1) in lower case; empty: a relative reference.
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

// Decodes a data URI: without ";base64" the bytes are percent-encoded; base64 may be, too.
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

// Returns the path from the package's folder that a URI means, without "." and "..".
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
  // Links are followed and judged by the file to which they lead.
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
    return read_file<Bytes>(path->string(), file_bytes_limit);
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
