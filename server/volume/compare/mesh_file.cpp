// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/mesh_file.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/load_error.h"
#include "base/read_file.h"

namespace wellspring::volume {

namespace {

constexpr size_t most_mesh_bytes = size_t(1) << 30;

// Takes words and numbers out of a file's bytes, in order.
struct MeshText {
  const std::string& file;
  std::string_view bytes;
  size_t at = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw LoadError(file, "byte " + std::to_string(at), what);
  }
  std::string_view word() {
    while (at < bytes.size() && std::strchr(" \t\r\n\v\f", bytes[at]) && bytes[at]) at++;
    const size_t begin = at;
    while (at < bytes.size() && !(std::strchr(" \t\r\n\v\f", bytes[at]) && bytes[at])) at++;
    return bytes.substr(begin, at - begin);
  }
  std::string_view line() {
    const size_t end = std::min(bytes.find('\n', at), bytes.size());
    std::string_view found = bytes.substr(at, end - at);
    at = std::min(end + 1, bytes.size());
    if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
    return found;
  }
  template <class Number>
  Number number() {
    std::string_view text = word();
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || end != text.data() + text.size())
      fail("'" + std::string(text.substr(0, 40)) + "' is no number");
    return value;
  }
  template <class Number>
  Number binary(bool swapped = false) {
    if (bytes.size() - at < sizeof(Number)) fail("the file ends within a number");
    char raw[sizeof(Number)];
    for (size_t i = 0; i < sizeof raw; i++) raw[i] = bytes[at + (swapped ? sizeof raw - 1 - i : i)];
    at += sizeof raw;
    Number value;
    std::memcpy(&value, raw, sizeof raw);
    return value;
  }
};

void add_corner(SurfaceMesh& mesh, dvec3 place) { mesh.positions.push_back(place); }

void number_corners(SurfaceMesh& mesh) {
  for (uint32_t i = 0; i + 2 < mesh.positions.size(); i += 3)
    mesh.triangles.push_back({i, i + 1, i + 2});
}

void read_stl(MeshText& text, SurfaceMesh& mesh) {
  uint32_t count = 0;
  if (text.bytes.size() >= 84) std::memcpy(&count, &text.bytes[80], sizeof count);
  // Many binary files begin with "solid", too: their size tells.
  if (text.bytes.size() >= 84 && text.bytes.size() - 84 >= uint64_t(count) * 50 &&
      (text.bytes.size() - 84 == uint64_t(count) * 50 || !text.bytes.starts_with("solid"))) {
    mesh.positions.reserve(size_t(count) * 3);
    for (uint32_t i = 0; i < count; i++) {
      text.at = 84 + size_t(i) * 50 + 12;
      for (int corner = 0; corner < 3; corner++) {
        const float x = text.binary<float>(), y = text.binary<float>(), z = text.binary<float>();
        add_corner(mesh, {x, y, z});
      }
    }
    return number_corners(mesh);
  }
  if (!text.bytes.starts_with("solid"))
    text.fail("is no STL: it neither begins with 'solid' nor is as long as its triangles need");
  text.line();
  int corners = 0;
  for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
    if (word == "vertex") {
      const double x = text.number<double>(), y = text.number<double>(), z = text.number<double>();
      add_corner(mesh, {x, y, z});
      corners++;
    } else if (word == "endfacet" || word == "endloop") {
      if (word == "endloop" && corners != 3) text.fail("a facet has not three vertices");
      corners = 0;
    }
  }
  if (mesh.positions.size() % 3 != 0) text.fail("the file ends within a facet");
  number_corners(mesh);
}

enum class PlyForm { text, little, big };

struct PlyProperty {
  std::string name, kind, count_kind;  // count_kind: of a list, else empty
};
struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

size_t ply_bytes(std::string_view kind) {
  if (kind == "char" || kind == "uchar" || kind == "int8" || kind == "uint8") return 1;
  if (kind == "short" || kind == "ushort" || kind == "int16" || kind == "uint16") return 2;
  if (kind == "int" || kind == "uint" || kind == "int32" || kind == "uint32") return 4;
  if (kind == "float" || kind == "float32") return 4;
  if (kind == "double" || kind == "float64") return 8;
  return 0;
}

double ply_number(MeshText& text, std::string_view kind, PlyForm form) {
  if (form == PlyForm::text) return text.number<double>();
  const bool swapped = (form == PlyForm::big) == (std::endian::native == std::endian::little);
  if (kind == "char" || kind == "int8") return text.binary<int8_t>();
  if (kind == "uchar" || kind == "uint8") return text.binary<uint8_t>();
  if (kind == "short" || kind == "int16") return text.binary<int16_t>(swapped);
  if (kind == "ushort" || kind == "uint16") return text.binary<uint16_t>(swapped);
  if (kind == "int" || kind == "int32") return text.binary<int32_t>(swapped);
  if (kind == "uint" || kind == "uint32") return text.binary<uint32_t>(swapped);
  if (kind == "float" || kind == "float32") return text.binary<float>(swapped);
  return text.binary<double>(swapped);
}

struct PlyHeader {
  PlyForm form = PlyForm::text;
  std::vector<PlyElement> elements;
};

PlyHeader read_ply_header(MeshText& text) {
  PlyHeader header;
  if (text.line() != "ply") text.fail("is no PLY: its first line is not 'ply'");
  for (int lines = 0;; lines++) {
    if (text.at >= text.bytes.size() || lines > 1000) text.fail("PLY header does not end");
    const std::string_view whole = text.line();
    MeshText line{text.file, whole};
    const std::string_view word = line.word();
    if (word == "end_header") return header;
    if (word == "format") {
      const std::string_view form = line.word();
      if (form == "ascii") header.form = PlyForm::text;
      else if (form == "binary_little_endian") header.form = PlyForm::little;
      else if (form == "binary_big_endian") header.form = PlyForm::big;
      else text.fail("PLY format '" + std::string(form.substr(0, 40)) + "' is unknown");
    } else if (word == "element") {
      const std::string_view name = line.word();
      header.elements.push_back({std::string(name), line.number<uint64_t>(), {}});
    } else if (word == "property") {
      if (header.elements.empty()) text.fail("a property of no element");
      PlyProperty property;
      property.kind = line.word();
      if (property.kind == "list") property.count_kind = line.word(), property.kind = line.word();
      property.name = line.word();
      if (ply_bytes(property.kind) == 0 ||
          (!property.count_kind.empty() && ply_bytes(property.count_kind) == 0))
        text.fail("a property of unknown kind '" + property.kind.substr(0, 40) + "'");
      header.elements.back().properties.push_back(property);
    }
  }
}

uint32_t ply_index(MeshText& text, double number) {
  if (!(number >= 0) || number > 4294967294.0 || number != std::floor(number))
    text.fail("a face names vertex " + std::to_string(number));
  return uint32_t(number);
}

void read_ply_list(MeshText& text, const PlyProperty& property, PlyForm form, SurfaceMesh* mesh) {
  const double count = ply_number(text, property.count_kind, form);
  if (!(count >= 0) || count > double(text.bytes.size() - text.at)) text.fail("a list is too long");
  uint32_t first = 0, before = 0;
  for (uint64_t i = 0; i < uint64_t(count); i++) {
    const double number = ply_number(text, property.kind, form);
    if (!mesh) continue;
    const uint32_t corner = ply_index(text, number);
    if (i == 0) first = corner;
    if (i >= 2) mesh->triangles.push_back({first, before, corner});
    before = corner;
  }
}

void read_ply(MeshText& text, SurfaceMesh& mesh) {
  const PlyHeader header = read_ply_header(text);
  for (const PlyElement& element : header.elements) {
    // Each has a byte at least, so a file cannot promise more than it has.
    if (element.properties.empty()) continue;
    if (element.count > text.bytes.size() - text.at) text.fail("PLY promises more than it has");
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (is_vertex) mesh.positions.reserve(size_t(element.count));
    for (uint64_t i = 0; i < element.count; i++) {
      dvec3 place(0);
      for (const PlyProperty& property : element.properties) {
        const bool corners = property.name == "vertex_indices" || property.name == "vertex_index";
        if (!property.count_kind.empty()) {
          read_ply_list(text, property, header.form, is_face && corners ? &mesh : nullptr);
          continue;
        }
        const double number = ply_number(text, property.kind, header.form);
        if (property.name == "x") place.x = number;
        if (property.name == "y") place.y = number;
        if (property.name == "z") place.z = number;
      }
      if (is_vertex) mesh.positions.push_back(place);
    }
  }
  for (const uvec3& triangle : mesh.triangles)
    if (std::max({triangle.x, triangle.y, triangle.z}) >= mesh.positions.size())
      text.fail("a face names a vertex that is not there");
}

bool ends_with_letters(const std::string& file, std::string_view end) {
  if (file.size() < end.size()) return false;
  for (size_t i = 0; i < end.size(); i++)
    if (std::tolower(uint8_t(file[file.size() - end.size() + i])) != end[i]) return false;
  return true;
}

}  // namespace

bool is_mesh_file(const std::string& file) {
  return ends_with_letters(file, ".stl") || ends_with_letters(file, ".ply");
}

SurfaceMesh read_mesh_file(const std::string& file, double metres) {
  const std::string bytes = read_file(file, most_mesh_bytes, FileKind::regular_or_pipe);
  MeshText text{file, bytes};
  SurfaceMesh mesh;
  if (ends_with_letters(file, ".ply")) read_ply(text, mesh);
  else read_stl(text, mesh);
  if (mesh.triangles.empty()) throw LoadError(file, "", "has no triangles");
  for (dvec3& position : mesh.positions) position *= metres;
  weld(mesh);
  return mesh;
}

}  // namespace wellspring::volume
