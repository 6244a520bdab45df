// SPDX-License-Identifier: Apache-2.0
#include "scan/splats/splat_file.h"

#include "base/load_error.h"
#include "base/read_file.h"
#include "scan/format/ply_header.h"
#include "scan/splats/splat_bytes.h"
#include "scan/splats/splat_finish.h"
#include "scan/splats/splat_gltf.h"
#include "scan/splats/splat_ply.h"
#include "scan/splats/spz.h"

namespace wellspring::scan {
namespace {

constexpr size_t most_bytes = size_t(1) << 32;  // formats that are read at once may have so many
constexpr size_t most_json = size_t(1) << 26;

enum class Kind : uint8_t { none, ply, spz, splat, ksplat, gltf };

bool is_named(std::string_view path, std::string_view end) {
  if (path.size() < end.size()) return false;
  path.remove_prefix(path.size() - end.size());
  for (size_t i = 0; i < end.size(); i++)
    if ((path[i] >= 'A' && path[i] <= 'Z' ? path[i] - 'A' + 'a' : path[i]) != end[i]) return false;
  return true;
}

// A glTF file of splats names the extension in its JSON.
bool names_extension(InputFile& file) {
  size_t length = most_json;
  if (const std::string_view head = file.peek(20); head.starts_with("glTF"))
    length = head.size() < 20 ? 0 : 20 + size_t(number_at<uint32_t>(head.data() + 12));
  const std::string_view text = file.peek(std::min(length, most_json)).substr(0, length);
  return text.find("\"KHR_gaussian_splatting\"") != std::string_view::npos;
}

Kind kind_of(const std::string& path) {
  InputFile file(path);
  if (is_ply(file)) return has_splats(read_ply_header(file)) ? Kind::ply : Kind::none;
  const std::string_view head = file.peek(4096).substr(0, 4096);
  if (head.starts_with("glTF") || is_named(path, ".gltf"))
    return names_extension(file) ? Kind::gltf : Kind::none;
  if (is_spz(head)) return Kind::spz;
  if (is_named(path, ".splat") && file.size() > 0) return Kind::splat;
  if (is_named(path, ".ksplat") && file.size() > 0) return Kind::ksplat;
  return Kind::none;
}

SplatSet read_kind(Kind kind, const std::string& path) {
  switch (kind) {
    case Kind::ply: return read_splat_ply(path);
    case Kind::gltf: return read_splat_gltf(path);
    case Kind::none:
      throw LoadError(path, "",
                      "holds no Gaussian splats that are read: PLY, SPZ, .splat, .ksplat, glTF "
                      "with KHR_gaussian_splatting");
    default: break;
  }
  const std::string bytes = read_file(path, most_bytes);
  if (kind == Kind::spz) return read_spz(path, "", bytes);
  return kind == Kind::splat ? read_splat(path, bytes) : read_ksplat(path, bytes);
}

}  // namespace

SplatSet load_splats(const std::string& path) {
  SplatSet set = read_kind(kind_of(path), path);
  finish_splats(set);
  return set;
}

bool holds_splats(const std::string& path) { return kind_of(path) != Kind::none; }

}  // namespace wellspring::scan
