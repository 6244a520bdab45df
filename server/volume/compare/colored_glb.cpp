// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/colored_glb.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace wellspring::volume {

namespace {

template <class Value>
void append_value(std::string& bytes, const Value& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append_chunk(std::string& glb, const char* kind, std::string bytes, char filler) {
  while (bytes.size() % 4) bytes.push_back(filler);
  append_value(glb, uint32_t(bytes.size()));
  glb.append(kind, 4);
  glb += bytes;
}

bool has_place(dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

nlohmann::ordered_json glb_numbers(dvec3 v) {
  return nlohmann::ordered_json::array({v.x, v.y, v.z});
}

}  // namespace

std::string colored_glb(const SurfaceMesh& mesh, const std::vector<vec3>& colors,
                        const std::string& name) {
  using Json = nlohmann::ordered_json;
  // Vertices that are kept, in order, and their new numbers.
  std::vector<uint32_t> number(mesh.positions.size(), UINT32_MAX), kept, indices;
  dvec3 low(INFINITY), high(-INFINITY);
  for (const uvec3& triangle : mesh.triangles) {
    bool whole = true;
    for (int i = 0; i < 3; i++) whole = whole && has_place(mesh.positions[triangle[i]]);
    if (!whole) continue;
    for (int i = 0; i < 3; i++) {
      const uint32_t vertex = triangle[i];
      if (number[vertex] == UINT32_MAX)
        number[vertex] = uint32_t(kept.size()), kept.push_back(vertex);
      indices.push_back(number[vertex]);
      low = glm::min(low, mesh.positions[vertex]), high = glm::max(high, mesh.positions[vertex]);
    }
  }
  if (kept.empty()) throw std::invalid_argument("the mesh has no triangle that can be written");
  const dvec3 middle = low * 0.5 + high * 0.5;
  std::string places, normals, shades;
  vec3 least(INFINITY), most(-INFINITY);
  for (uint32_t vertex : kept) {
    const vec3 place(mesh.positions[vertex] - middle);
    least = glm::min(least, place), most = glm::max(most, place);
    append_value(places, place);
    const vec3 normal = mesh.normals[vertex];
    append_value(normals, glm::dot(normal, normal) > 0 ? normal : vec3(0, 1, 0));
    for (int i = 0; i < 3; i++)
      append_value(shades,
                   uint16_t(std::lround(std::clamp(colors[vertex][i], 0.0f, 1.0f) * 65535)));
    append_value(shades, uint16_t(65535));
  }
  const std::string corners(reinterpret_cast<const char*>(indices.data()), indices.size() * 4);
  std::string binary = places + normals + shades + corners;
  if (binary.size() > 0xf0000000u) throw std::invalid_argument("the mesh is too large for a GLB");
  const size_t count = kept.size();
  auto view = [](size_t offset, size_t length, int target) {
    return Json{{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}, {"target", target}};
  };
  auto accessor = [](int view, int component, size_t count, const char* type) {
    return Json{
        {"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
  };
  constexpr int is_float = 5126, is_u16 = 5123, is_u32 = 5125, vertices = 34962, elements = 34963;
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "wellspring compare"}};
  json["scene"] = 0;
  json["scenes"] = Json::array({Json{{"nodes", Json::array({0})}}});
  Json node{{"name", name}, {"mesh", 0}};
  node["translation"] = glb_numbers(middle);
  json["nodes"] = Json::array({node});
  Json primitive{{"indices", 3}, {"material", 0}};
  primitive["attributes"] = {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}};
  json["meshes"] = Json::array({Json{{"name", name}, {"primitives", Json::array({primitive})}}});
  Json material{{"name", "deviation"}, {"doubleSided", true}};
  material["pbrMetallicRoughness"] = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
  json["materials"] = Json::array({material});
  json["accessors"] = Json::array(
      {accessor(0, is_float, count, "VEC3"), accessor(1, is_float, count, "VEC3"),
       accessor(2, is_u16, count, "VEC4"), accessor(3, is_u32, indices.size(), "SCALAR")});
  json["accessors"][0]["min"] = glb_numbers(dvec3(least));
  json["accessors"][0]["max"] = glb_numbers(dvec3(most));
  json["accessors"][2]["normalized"] = true;
  const size_t after_normals = places.size() + normals.size();
  json["bufferViews"] =
      Json::array({view(0, places.size(), vertices), view(places.size(), normals.size(), vertices),
                   view(after_normals, shades.size(), vertices),
                   view(after_normals + shades.size(), corners.size(), elements)});
  json["buffers"] = Json::array({Json{{"byteLength", binary.size()}}});
  std::string chunks;
  append_chunk(chunks, "JSON", json.dump(-1, ' ', false, Json::error_handler_t::replace), ' ');
  append_chunk(chunks, std::string("BIN\0", 4).c_str(), std::move(binary), '\0');
  std::string glb = "glTF";
  append_value(glb, uint32_t(2));
  append_value(glb, uint32_t(chunks.size() + 12));
  return glb + chunks;
}

}  // namespace wellspring::volume
