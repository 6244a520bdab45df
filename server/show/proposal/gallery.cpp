// SPDX-License-Identifier: Apache-2.0
#include "show/proposal/gallery.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/write_file.h"

namespace wellspring::show {
namespace {

using Gltf = nlohmann::ordered_json;

// Metres, if nothing else is said.
constexpr double side_room = 1.2, gap = 0.9, least_slot = 0.6;
constexpr double middle_height = 1.55, least_bottom = 0.35;
constexpr double least_height = 3.2, over_pictures = 0.7;
constexpr double least_depth = 4.5, usual_depth = 9;
constexpr double behind_eye = 0.7, nearest = 0.9;
constexpr double lamp_below = 0.3, lamp_before = 1.3;
constexpr double light_on_picture = 3;                 // W/m^2
constexpr double picture_fov = 50, overview_fov = 60;  // degrees, vertical
constexpr double a_degree = 3.14159265358979323846 / 180;
constexpr double off_wall = 0.002;
constexpr double screen = 4.0 / 3;  // a picture fits into a window of these proportions

// Returns how far away a picture fits into a window, with a little to spare.
double distance_to(const HungPicture& one) {
  const double tan_y = std::tan(0.5 * picture_fov * a_degree);
  const double far = 1.2 * 0.5 * std::max(one.height / tan_y, one.width / (tan_y * screen));
  return std::max(far, nearest);
}

GalleryView look_at(dvec3 eye, dvec3 at, double fov) {
  const dvec3 way = at - eye;
  return {eye, std::atan2(-way.x, -way.z), std::atan2(way.y, std::hypot(way.x, way.z)),
          fov * a_degree};
}

// Collects flat sides of a room.
struct RoomMesh {
  Gltf file;
  std::string bytes;

  void put(const void* values, size_t size) {
    bytes.append(static_cast<const char*>(values), size);
  }
  int add_view(size_t size, int target) {
    Gltf& views = file["bufferViews"];
    views.push_back({{"buffer", 0},
                     {"byteOffset", bytes.size() - size},
                     {"byteLength", size},
                     {"target", target}});
    return int(views.size()) - 1;
  }
  int add_vectors(const std::vector<vec3>& vectors) {
    vec3 low = vectors.front(), high = low;
    for (const vec3& v : vectors) {
      const float numbers[] = {v.x, v.y, v.z};
      put(numbers, sizeof numbers);
      low = glm::min(low, v), high = glm::max(high, v);
    }
    file["accessors"].push_back({{"bufferView", add_view(vectors.size() * 12, 34962)},
                                 {"componentType", 5126},
                                 {"count", vectors.size()},
                                 {"type", "VEC3"},
                                 {"min", {low.x, low.y, low.z}},
                                 {"max", {high.x, high.y, high.z}}});
    return int(file["accessors"].size()) - 1;
  }
  void add_indices() {
    const uint16_t indices[] = {0, 1, 2, 0, 2, 3};
    put(indices, sizeof indices);
    file["accessors"].push_back({{"bufferView", add_view(sizeof indices, 34963)},
                                 {"componentType", 5123},
                                 {"count", 6},
                                 {"type", "SCALAR"}});
  }
  void add_node(Gltf node) {
    file["scenes"][0]["nodes"].push_back(file.contains("nodes") ? file["nodes"].size() : 0);
    file["nodes"].push_back(std::move(node));
  }
  // Adds a side, corners anticlockwise as seen from within.
  void add_side(const char* name, int material, vec3 a, vec3 b, vec3 c, vec3 d) {
    const vec3 normal = glm::normalize(cross(b - a, d - a));
    const int places = add_vectors({a, b, c, d});
    const int normals = add_vectors({normal, normal, normal, normal});
    file["meshes"].push_back(
        {{"name", name},
         {"primitives", Gltf::array({{{"attributes", {{"POSITION", places}, {"NORMAL", normals}}},
                                      {"indices", 0},
                                      {"material", material}}})}});
    add_node({{"name", name}, {"mesh", file["meshes"].size() - 1}});
  }
  void add_material(const char* name, double red, double green, double blue, double roughness) {
    file["materials"].push_back({{"name", name},
                                 {"pbrMetallicRoughness",
                                  {{"baseColorFactor", {red, green, blue, 1}},
                                   {"metallicFactor", 0},
                                   {"roughnessFactor", roughness}}}});
  }
};

}  // namespace

Gallery hang_gallery(std::vector<HungPicture> pictures, double eye_height) {
  Gallery gallery;
  double x = side_room, top = 0, depth = least_depth;
  for (HungPicture& one : pictures) {
    const double slot = std::max(one.width, least_slot);
    const double middle = std::max(middle_height, 0.5 * one.height + least_bottom);
    one.place = {x + 0.5 * slot, middle, off_wall};
    x += slot + gap;
    top = std::max(top, middle + 0.5 * one.height);
    depth = std::max(depth, distance_to(one) + behind_eye);
  }
  const double width = x - gap + side_room;
  depth = std::max(depth, std::min(usual_depth, 0.7 * width + behind_eye));
  gallery.size = {width, std::max(least_height, top + over_pictures), depth};
  for (const HungPicture& one : pictures) {
    gallery.lamps.push_back({one.place.x, gallery.size.y - lamp_below, lamp_before});
    const dvec3 eye(one.place.x, eye_height, distance_to(one));
    gallery.views.push_back(look_at(eye, one.place, picture_fov));
  }
  // The overview is from the middle if all of the wall is seen from there, else from a corner.
  const double back = depth - behind_eye;
  const double half = std::tan(0.5 * overview_fov * a_degree) * screen * back;
  const bool fits = 0.5 * width <= half;
  const dvec3 eye(fits ? 0.5 * width : behind_eye, eye_height, back);
  const double at = fits ? 0.5 * width : std::min(0.5 * width, behind_eye + 1.2 * back);
  gallery.overview = look_at(eye, {at, eye_height, 0}, overview_fov);
  gallery.pictures = std::move(pictures);
  return gallery;
}

void write_gallery(const Gallery& gallery, const std::string& folder) {
  const float x = float(gallery.size.x), y = float(gallery.size.y), z = float(gallery.size.z);
  RoomMesh room;
  room.file = {{"asset", {{"version", "2.0"}, {"generator", "Wellspring"}}},
               {"extensionsUsed", {"KHR_lights_punctual"}},
               {"scene", 0}};
  room.add_material("Floor", 0.3, 0.2, 0.13, 0.6);
  room.add_material("Wall", 0.72, 0.7, 0.66, 0.9);
  room.add_material("Ceiling", 0.8, 0.8, 0.8, 0.9);
  room.add_indices();
  room.add_side("Floor", 0, {0, 0, z}, {x, 0, z}, {x, 0, 0}, {0, 0, 0});
  room.add_side("Ceiling", 2, {0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z});
  room.add_side("Picture wall", 1, {0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0});
  room.add_side("Back wall", 1, {x, 0, z}, {0, 0, z}, {0, y, z}, {x, y, z});
  room.add_side("Left wall", 1, {0, 0, z}, {0, 0, 0}, {0, y, 0}, {0, y, z});
  room.add_side("Right wall", 1, {x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0});
  Gltf lights = Gltf::array();
  for (size_t i = 0; i < gallery.lamps.size(); i++) {
    const dvec3 lamp = gallery.lamps[i], way = gallery.pictures[i].place - lamp;
    const double candela = std::round(100 * light_on_picture * dot(way, way)) / 100;
    auto same =
        std::ranges::find_if(lights, [&](const Gltf& one) { return one["intensity"] == candela; });
    const auto number = same - lights.begin();
    if (same == lights.end()) lights.push_back({{"type", "point"}, {"intensity", candela}});
    room.add_node({{"name", "Lamp " + std::to_string(i + 1)},
                   {"translation", {lamp.x, lamp.y, lamp.z}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", number}}}}}});
  }
  room.file["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
  room.file["buffers"].push_back({{"uri", "gallery.bin"}, {"byteLength", room.bytes.size()}});
  write_file(folder + "/gallery.bin", room.bytes);
  const std::string text = room.file.dump(2) + "\n";
  write_file(folder + "/gallery.gltf", text);
}

}  // namespace wellspring::show
