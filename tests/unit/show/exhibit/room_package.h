// SPDX-License-Identifier: Apache-2.0
// A package of a test's own: boxes and lamps in a glTF file, and what exhibit.json says of them.
#pragma once
#include <string>
#include <vector>

#include "show/check/check_scene.h"
#include "show/exhibit/load/exhibit_load.h"
#include "unit/folder.h"
#include "unit/world/load/asset.h"

namespace wellspring::test {

// A box of its own mesh; `inward`: a room, whose faces look inwards.
inline void add_box(Asset& asset, const std::string& name, vec3 low, vec3 high, bool inward,
                    const json& more = json::object()) {
  std::vector<float> positions;
  for (int axis = 0; axis < 3; axis++)
    for (int side = 0; side < 2; side++) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::vector<vec3> corners;
      for (auto [a, b] : {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
        vec3 p(0);
        p[axis] = side ? high[axis] : low[axis];
        p[u] = a ? high[u] : low[u];
        p[v] = b ? high[v] : low[v];
        corners.push_back(p);
      }
      if ((side == 1) == inward) std::swap(corners[1], corners[3]);
      for (int i : {0, 1, 2, 0, 2, 3})
        for (int k = 0; k < 3; k++) positions.push_back(corners[size_t(i)][k]);
    }
  int material = 0;
  if (asset.root.contains("materials")) material = int(asset.root["materials"].size());
  asset.root["materials"].push_back(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.6, 0.6, 0.6, 1}}}}});
  int mesh = asset.add_mesh({{"attributes", {{"POSITION", asset.add_floats("VEC3", 3, positions)}}},
                             {"material", material}});
  json node = {{"name", name}, {"mesh", mesh}};
  node.update(more);
  asset.add_node(node);
}

inline void add_point_light(Asset& asset, const std::string& name, vec3 at, float candela) {
  json& lights = asset.root["extensions"]["KHR_lights_punctual"]["lights"];
  asset.root["extensionsUsed"] = {"KHR_lights_punctual"};
  lights.push_back({{"type", "point"}, {"intensity", candela}});
  asset.add_node({{"name", name},
                  {"translation", {at.x, at.y, at.z}},
                  {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
}

// Moves a node by `way` and back in two seconds, or there in one.
inline void add_clip(Asset& asset, const std::string& name, int node, vec3 way, bool back) {
  std::vector<float> times = {0, 1}, values = {0, 0, 0, way.x, way.y, way.z};
  if (back) times.push_back(2), values.insert(values.end(), {0, 0, 0});
  const int in = asset.add_floats("SCALAR", 1, times), out = asset.add_floats("VEC3", 3, values);
  asset.root["animations"].push_back(
      {{"name", name},
       {"samplers", {{{"input", in}, {"output", out}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}}}}});
}

// 8 x 3 x 6 m with a table in the middle and a lamp over it.
inline Asset room_asset(float candela = 8) {
  Asset asset;
  add_box(asset, "Room", {-4, 0, -3}, {4, 3, 3}, true);
  add_box(asset, "Table", {-1, 0, -1}, {1, 0.8f, 0}, false);
  if (candela > 0) add_point_light(asset, "Lamp", {0, 2.6f, 0}, candela);
  return asset;
}

struct RoomPackage {
  Folder folder;
  json manifest = {{"title", {{"en", "Room"}}},
                   {"scene", "scene.gltf"},
                   {"viewpoints", json::array({{{"name", "door"}, {"position", {0, 1.65, 2.5}}}})}};
  std::vector<Problem> problems;

  explicit RoomPackage(const Asset& asset = room_asset()) {
    std::filesystem::create_directories(folder.path / "room");
    write("scene.gltf", asset.gltf());
  }
  void write(const std::string& name, const std::string& bytes) const {
    folder.write("room/" + name, bytes);
  }
  Exhibit read() {
    write("exhibit.json", manifest.dump(1));
    problems.clear();
    return read_exhibit(folder.file("room"), problems);
  }
  // All that `./wellspring check` says of the scene.
  Exhibit check() {
    Exhibit exhibit = read();
    World world(exhibit.scene);
    check_places(exhibit, world, problems);
    check_sides(exhibit, world, problems);
    check_lawns(exhibit, world, problems);
    check_light(exhibit, world, problems);
    return exhibit;
  }
  std::string told() const {
    std::string all;
    for (const Problem& problem : problems) all += to_string(problem) + "\n";
    return all;
  }
  // Counts the problems that lie at `where` and hold these words.
  int says(const std::string& where, const std::string& what) const {
    int count = 0;
    for (const Problem& problem : problems)
      count += problem.where == where && problem.what.find(what) != std::string::npos;
    return count;
  }
};

}  // namespace wellspring::test
