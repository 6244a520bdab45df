// SPDX-License-Identifier: Apache-2.0
// From path to JSON and bytes: the GLB container (glTF 2.0 section 4), nesting limits, URIs, the
// package.
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/load_error.h"
#include "gltf/file.h"

namespace wellspring::gltf {
namespace {

namespace fs = std::filesystem;

constexpr size_t file_limit = size_t(2) << 30;
constexpr size_t json_limit = size_t(1) << 28;
constexpr int depth_limit = 100;
constexpr size_t warning_limit = 200;

uint32_t word(const Bytes& bytes, size_t offset) {
  return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 |
         uint32_t(bytes[offset + 2]) << 16 | uint32_t(bytes[offset + 3]) << 24;
}

// The JSON library copies and prints by recursion, so depth is bounded before it sees the text.
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
  if (size_t(end - begin) > json_limit) refuse(file, "", "more than 256 MiB of JSON");
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

void split_glb(File& file, const Bytes& bytes) {
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
      file.binary.assign(data, data + size);
      file.has_binary = true;
    } else {
      warn(file, where, "an unknown GLB chunk is ignored");
    }
    offset += 8 + size;
  }
  if (!has_json) refuse(file, "byte 12", "GLB has no JSON chunk");
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

Bytes decode_base64(const File& file, const std::string& where, const char* p, const char* end) {
  auto value = [](char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
  };
  while (end > p && end[-1] == '=') end--;
  Bytes bytes;
  bytes.reserve(size_t(end - p) * 3 / 4);
  uint32_t bits = 0;
  int count = 0;
  for (; p < end; p++) {
    int v = value(*p);
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

// A data URI without ";base64" carries percent-encoded bytes (RFC 2397).
Bytes decode_data_uri(const File& file, const std::string& where, const std::string& uri) {
  size_t comma = uri.find(',');
  if (comma == std::string::npos) refuse(file, where, "data URI without a comma");
  std::string head = uri.substr(0, comma);
  if (head.size() >= 7 && head.compare(head.size() - 7, 7, ";base64") == 0)
    return decode_base64(file, where, uri.data() + comma + 1, uri.data() + uri.size());
  std::string decoded = percent_decode(file, where, uri.substr(comma + 1));
  return Bytes(decoded.begin(), decoded.end());
}

}  // namespace

void refuse(const File& file, const std::string& where, const std::string& what) {
  throw LoadError(file.path, where, what);
}

void warn(File& file, const std::string& where, const std::string& what) {
  if (file.warnings.size() >= warning_limit || !file.said.insert(what).second) return;
  file.warnings.push_back(where.empty() ? what : where + ": " + what);
}

Bytes read_bytes(const std::string& path, size_t limit) {
  std::error_code error;
  if (!fs::exists(path, error)) throw LoadError(path, "", "no such file");
  if (!fs::is_regular_file(path, error)) throw LoadError(path, "", "not a regular file");
  uintmax_t size = fs::file_size(path, error);
  if (error) throw LoadError(path, "", "cannot be read: " + error.message());
  if (size > limit)
    throw LoadError(path, "", "larger than " + std::to_string(limit >> 20) + " MiB");
  std::ifstream stream(path, std::ios::binary);
  Bytes bytes(size);
  if (size > 0) stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
  if (!stream || size_t(stream.gcount()) != (size > 0 ? size : 0))
    throw LoadError(path, "", "cannot be read");
  return bytes;
}

std::string percent_decode(const File& file, const std::string& where, const std::string& uri) {
  std::string decoded;
  for (size_t i = 0; i < uri.size(); i++) {
    if (uri[i] != '%') {
      decoded += uri[i];
      continue;
    }
    int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) refuse(file, where, "bad percent escape in URI");
    decoded += char(high * 16 + low);
    i += 2;
  }
  return decoded;
}

std::optional<Bytes> read_uri(const File& file, const std::string& where, const std::string& uri) {
  if (uri.compare(0, 5, "data:") == 0) return decode_data_uri(file, where, uri);
  std::string name = percent_decode(file, where, uri);
  auto outside = [&] {
    refuse(file, where, "\"" + uri.substr(0, 200) + "\" does not lie inside the package");
  };
  size_t colon = name.find(':'), slash = name.find_first_of("/?#");
  if (colon != std::string::npos && (slash == std::string::npos || colon < slash)) outside();
  if (name.empty() || name.find('\0') != std::string::npos || name.find('\\') != std::string::npos)
    outside();
  fs::path relative(name);
  if (relative.is_absolute()) outside();
  for (const fs::path& part : relative)
    if (part == "..") outside();
  // Links are followed first and judged by where they lead.
  std::error_code error;
  fs::path resolved = fs::weakly_canonical(file.folder / relative, error);
  if (error) outside();
  auto [end_of_package, rest] =
      std::mismatch(file.package.begin(), file.package.end(), resolved.begin(), resolved.end());
  if (end_of_package != file.package.end()) outside();
  if (!fs::exists(resolved, error)) return std::nullopt;
  try {
    return read_bytes(resolved.string(), file_limit);
  } catch (const LoadError& problem) {
    refuse(file, where, "file \"" + uri.substr(0, 200) + "\": " + problem.what_);
  }
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
  Bytes bytes = read_bytes(path, file_limit);
  if (bytes.size() >= 4 && word(bytes, 0) == 0x46546c67) {  // "glTF"
    split_glb(file, bytes);
  } else {
    const char* data = reinterpret_cast<const char*>(bytes.data());
    parse_json(file, data, data + bytes.size());
  }
  bytes = Bytes();
  check_schema(file);
  check_extensions(file, further);
  check_layout(file);
  file.buffers.resize(items(file.root, "buffers").size());
  file.buffer_ready.assign(file.buffers.size(), 0);
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

}  // namespace wellspring::gltf
