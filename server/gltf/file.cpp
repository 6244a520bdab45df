// SPDX-License-Identifier: Apache-2.0
// From path to JSON and bytes: the GLB container (glTF 2.0 section 4), nesting limits, the package.
#include <cmath>
#include <cstring>
#include <fstream>

#include "base/load_error.h"
#include "base/unicode.h"
#include "gltf/file.h"
#include "gltf/limits.h"

namespace wellspring::gltf {
namespace {

namespace fs = std::filesystem;

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

// Takes the bytes: those of the binary chunk stay, without a copy.
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

// Names are compared with those of other files: exhibit.json, stories (base/unicode.h).
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
  Bytes bytes = read_bytes(path, file_bytes_limit);
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

}  // namespace wellspring::gltf
