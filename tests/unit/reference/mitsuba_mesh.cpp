// SPDX-License-Identifier: Apache-2.0
#include "mitsuba_mesh.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "base/load_error.h"
#include "mitsuba_xml.h"
#include "scenes/build.h"
#include "world/mesh_finish.h"

namespace wellspring::mitsuba {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& where,
                       const char* what) {
  throw LoadError{file.string(), where, what};
}

// A property of a PLY element: where it lies in the element's bytes.
struct PlyElement {
  size_t count = 0, bytes = 0;
  std::map<std::string, size_t> offset;  // bytes at which a float lies
};

float float_at(const uint8_t* p) {
  float x;
  std::memcpy(&x, p, 4);
  return x;
}

using Place = std::array<float, 3>;
Place place_of(vec3 p) { return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; }

template <class T>
void take(std::vector<T>& values, const std::vector<uint32_t>& from) {
  std::vector<T> result;
  for (uint32_t i : from)
    if (!values.empty()) result.push_back(values[i]);
  values = std::move(result);
}

}  // namespace

MeshWithAttributes load_obj(const std::filesystem::path& file) {
  std::vector<uint8_t> bytes = read_bytes(file);
  std::istringstream in(std::string(bytes.begin(), bytes.end()));
  std::vector<vec3> position, normal;
  std::vector<vec2> uv;
  std::map<std::array<int, 3>, uint32_t> seen;
  MeshWithAttributes result;
  Mesh& mesh = result.mesh;
  bool with_normals = true, with_uv = true;
  std::string line, word;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    words >> word;
    vec3 v(0);
    if (line.rfind("v ", 0) == 0) {
      words >> v.x >> v.y >> v.z;
      position.push_back(v);
    } else if (line.rfind("vn ", 0) == 0) {
      words >> v.x >> v.y >> v.z;
      normal.push_back(v);
    } else if (line.rfind("vt ", 0) == 0) {
      words >> v.x >> v.y;
      uv.push_back({v.x, 1 - v.y});
    } else if (line.rfind("f ", 0) == 0) {
      std::vector<uint32_t> corners;
      while (words >> word) {
        std::array<int, 3> index = {0, 0, 0};  // 1-based; 0: none
        size_t at = 0;
        for (int i = 0; i < 3 && at <= word.size(); i++) {
          size_t end = std::min(word.find('/', at), word.size());
          index[size_t(i)] = std::atoi(word.substr(at, end - at).c_str());
          at = end + 1;
        }
        size_t sizes[3] = {position.size(), uv.size(), normal.size()};
        for (size_t i = 0; i < 3; i++)
          if (index[i] < (i == 0) || size_t(index[i]) > sizes[i]) fail(file, line, "bad index");
        auto [slot, fresh] = seen.try_emplace(index, uint32_t(mesh.positions.size()));
        if (fresh) {
          mesh.positions.push_back(position[size_t(index[0] - 1)]);
          mesh.uv[0].push_back(index[1] ? uv[size_t(index[1] - 1)] : vec2(0));
          mesh.normals.push_back(index[2] ? normalize(normal[size_t(index[2] - 1)]) : vec3(0));
          with_uv = with_uv && index[1];
          with_normals = with_normals && index[2];
        }
        corners.push_back(slot->second);
      }
      for (size_t i = 2; i < corners.size(); i++)
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  if (mesh.triangles.empty()) fail(file, "", "no faces");
  if (!with_uv) mesh.uv[0].clear();
  if (!with_normals) repair_normals(mesh);
  return result;
}

MeshWithAttributes load_ply(const std::filesystem::path& file) {
  std::vector<uint8_t> bytes = read_bytes(file);
  std::string head(bytes.begin(), bytes.end());
  size_t end = head.find("end_header\n");
  if (end == std::string::npos) fail(file, "header", "no end");
  std::istringstream in(head.substr(0, end));
  std::map<std::string, PlyElement> elements;
  std::string line, element;
  bool binary = false;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word, type, name;
    words >> word >> type >> name;
    if (word == "format") binary = type == "binary_little_endian";
    if (word == "element") elements[element = type].count = std::stoul(name);
    if (word != "property") continue;
    if (type == "list") {  // uchar count, then int indices; triangles only
      elements[element].bytes += 1 + 3 * 4;
    } else {
      if (type != "float") fail(file, line, "only floats are read");
      elements[element].offset[name] = elements[element].bytes;
      elements[element].bytes += 4;
    }
  }
  const PlyElement vertex = elements["vertex"], face = elements["face"];
  const uint8_t* data = bytes.data() + end + 11;
  if (!binary || vertex.count * vertex.bytes + face.count * face.bytes != bytes.size() - (end + 11))
    fail(file, "body", "not the size that the header says");
  MeshWithAttributes result;
  auto read3 = [](const uint8_t* at, const PlyElement& e, const char* a, const char* b,
                  const char* c) {
    return vec3(float_at(at + e.offset.at(a)), float_at(at + e.offset.at(b)),
                float_at(at + e.offset.at(c)));
  };
  for (size_t i = 0; i < vertex.count; i++, data += vertex.bytes) {
    result.mesh.positions.push_back(read3(data, vertex, "x", "y", "z"));
    result.mesh.normals.push_back(
        vertex.offset.count("nx") ? normalize(read3(data, vertex, "nx", "ny", "nz")) : vec3(0));
    if (vertex.offset.count("u"))
      result.mesh.uv[0].push_back(
          {float_at(data + vertex.offset.at("u")), float_at(data + vertex.offset.at("v"))});
    if (vertex.offset.count("color_0"))
      result.vertex_color.push_back(read3(data, vertex, "color_0", "color_1", "color_2"));
  }
  for (size_t i = 0; i < face.count; i++, data += face.bytes) {
    uvec3 t;
    std::memcpy(&t, data + 1, 12);
    if (data[0] != 3 || std::max(std::max(t.x, t.y), t.z) >= vertex.count)
      fail(file, "face", "bad");
    result.mesh.triangles.push_back(t);
    if (face.offset.count("color_0"))
      result.face_color.push_back(read3(data, face, "color_0", "color_1", "color_2"));
    if (face.offset.count("weight_0"))
      result.face_weight.push_back(float_at(data + face.offset.at("weight_0")));
  }
  repair_normals(result.mesh);
  return result;
}

MeshWithAttributes make_rectangle() {
  MeshWithAttributes result;
  scenes::append_quad(result.mesh, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  return result;
}

MeshWithAttributes make_sphere() {
  MeshWithAttributes result;
  result.mesh = scenes::sphere_mesh(0, 1, 256);
  return result;
}

bool is_closed(const Mesh& mesh) {
  std::map<std::pair<Place, Place>, int> open;
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; i++) {
      Place a = place_of(mesh.positions[t[i]]), b = place_of(mesh.positions[t[(i + 1) % 3]]);
      if (a == b) continue;
      if (auto found = open.find({b, a}); found != open.end()) {
        if (--found->second == 0) open.erase(found);
      } else {
        open[{a, b}]++;
      }
    }
  return open.empty();
}

void split_faces(MeshWithAttributes& m) {
  std::vector<uint32_t> from;
  for (uvec3& t : m.mesh.triangles) {
    uint32_t first = uint32_t(from.size());
    for (int i = 0; i < 3; i++) from.push_back(t[i]);
    t = uvec3(first) + uvec3(0, 1, 2);
  }
  take(m.mesh.positions, from);
  take(m.mesh.normals, from);
  take(m.mesh.uv[0], from);
  take(m.mesh.colors, from);
  take(m.vertex_color, from);
}

}  // namespace wellspring::mitsuba
