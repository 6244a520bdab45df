// SPDX-License-Identifier: Apache-2.0
// Small glTF files made by the tests themselves, in a folder of their own that goes away
// afterwards.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/load_error.h"
#include "world/load/scene_load.h"

namespace wellspring::test {

using nlohmann::json;

class TempFolder {
 public:
  TempFolder() {
    static int counter = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("wellspring_world_" + std::to_string(getpid()) + "_" + std::to_string(counter++));
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  std::string write(const std::string& name, const std::string& bytes) const {
    std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file.string();
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string base64(const std::string& bytes) {
  static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t v = 0;
    for (size_t k = 0; k < 3; k++) v = v << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; k++)
      out += i + k > bytes.size() ? '=' : digits[v >> (18 - 6 * k) & 63];
  }
  return out;
}

// A glTF asset under construction; all its data goes to one buffer.
struct Asset {
  json root = {{"asset", {{"version", "2.0"}}}};
  std::string bytes;

  template <class T>
  int add_view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4) bytes += '\0';
    json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride) view["byteStride"] = stride;
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    root["bufferViews"].push_back(view);
    return int(root["bufferViews"].size()) - 1;
  }
  // view < 0: an accessor without data.
  int add_accessor(int view, int component_type, const char* type, size_t count,
                   const json& more = json::object()) {
    json accessor = {{"componentType", component_type}, {"type", type}, {"count", count}};
    if (view >= 0) accessor["bufferView"] = view;
    accessor.update(more);
    root["accessors"].push_back(accessor);
    return int(root["accessors"].size()) - 1;
  }
  int add_floats(const char* type, int components, const std::vector<float>& values) {
    return add_accessor(add_view(values), 5126, type, values.size() / size_t(components));
  }
  int add_mesh(const json& primitive) {
    root["meshes"].push_back({{"primitives", json::array({primitive})}});
    return int(root["meshes"].size()) - 1;
  }
  // Adds the node to the only scene as well.
  int add_node(const json& node) {
    root["nodes"].push_back(node);
    int index = int(root["nodes"].size()) - 1;
    root["scene"] = 0;
    if (!root.contains("scenes")) root["scenes"].push_back({{"nodes", json::array()}});
    root["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  json finished(bool embed) const {
    json result = root;
    if (!bytes.empty()) {
      json buffer = {{"byteLength", bytes.size()}};
      if (embed) buffer["uri"] = "data:application/octet-stream;base64," + base64(bytes);
      result["buffers"] = json::array({buffer});
    }
    return result;
  }
  std::string gltf() const { return finished(true).dump(); }
  std::string glb() const {
    std::string text = finished(false).dump(), binary = bytes;
    while (text.size() % 4) text += ' ';
    while (binary.size() % 4) binary += '\0';
    auto word = [](uint32_t v) {
      std::string s(4, '\0');
      std::memcpy(s.data(), &v, 4);
      return s;
    };
    std::string body = word(uint32_t(text.size())) + "JSON" + text;
    if (!binary.empty()) body += word(uint32_t(binary.size())) + std::string("BIN\0", 4) + binary;
    return "glTF" + word(2) + word(uint32_t(12 + body.size())) + body;
  }
};

// One triangle (0,0,0) (1,0,0) (0,1,0) shown by one node.
inline Asset triangle_asset() {
  Asset asset;
  int position = asset.add_floats("VEC3", 3, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  asset.add_mesh({{"attributes", {{"POSITION", position}}}});
  asset.add_node({{"mesh", 0}, {"name", "triangle"}});
  return asset;
}

inline Scene load_scene_text(const std::string& text, double time = 0) {
  TempFolder folder;
  return load_scene(folder.write("test.gltf", text), {time, ""});
}
inline Scene load(const Asset& asset, double time = 0) {
  return load_scene_text(asset.gltf(), time);
}

// The error that loading gives; fails the test if there is none.
inline LoadError refused(const std::string& text, const std::string& name = "test.gltf") {
  TempFolder folder;
  std::string path = folder.write(name, text);
  try {
    load_scene(path);
  } catch (const LoadError& error) {
    EXPECT_EQ(error.file, path);
    EXPECT_FALSE(error.what_.empty());
    return error;
  }
  ADD_FAILURE() << "loaded what should be refused";
  return LoadError("", "", "");
}
inline LoadError refused(const Asset& asset) { return refused(asset.gltf()); }

inline bool warns_of(const Scene& scene, const std::string& part) {
  for (const std::string& warning : scene.warnings)
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

inline void expect_near(vec3 a, vec3 b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// World position of corner `corner` of an instance's triangle.
inline vec3 corner_of(const Scene& scene, size_t instance, size_t triangle, int corner) {
  const Instance& i = scene.instances[instance];
  const Mesh& mesh = scene.meshes[size_t(i.mesh)];
  return vec3(i.to_world * vec4(mesh.positions[mesh.triangles[triangle][corner]], 1));
}

}  // namespace wellspring::test
