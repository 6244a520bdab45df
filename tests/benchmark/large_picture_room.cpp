// SPDX-License-Identifier: Apache-2.0
#include "large_picture_room.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "base/child.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int picture_repeats =
    4;  // so often the part that is drawn lies in a row, and in a column

uint32_t scramble(uint32_t x, uint32_t y, uint32_t octave) {
  uint32_t bits = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ (octave + 1) * 0xc2b2ae3du;
  bits = (bits ^ bits >> 15) * 0x2c1b3c6du;
  return bits ^ bits >> 13;
}

// Writes gradients and noise: squares of all sizes from a texel to 128, larger ones stronger, as in
// photographs, so that each level has something that the next coarser one has not.
void write_part(const std::string& file, int width, int height) {
  constexpr int strength[] = {6, 12, 24, 32, 32, 32, 32, 32};  // codes
  std::ofstream out(file, std::ios::binary);
  out << "P6\n" << width << " " << height << "\n255\n";
  std::vector<uint8_t> row(size_t(width) * 3);
  for (int y = 0; y < height; y++) {
    for (int x = 0; x < width; x++) {
      int noise = 0;
      for (uint32_t i = 0; i < std::size(strength); i++) {
        const uint32_t bits = scramble(uint32_t(x) >> i, uint32_t(y) >> i, i);
        noise += int(bits % uint32_t(strength[i])) - strength[i] / 2;
      }
      const int across = 80 + 96 * x / width, down = 80 + 96 * y / height;
      uint8_t* texel = &row[size_t(x) * 3];
      texel[0] = uint8_t(std::clamp(across + noise, 0, 255));
      texel[1] = uint8_t(std::clamp(down + noise, 0, 255));
      texel[2] = uint8_t(std::clamp(224 - across + noise, 0, 255));
    }
    out.write(reinterpret_cast<const char*>(row.data()), std::streamsize(row.size()));
  }
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

void make_picture(const std::string& part, const std::string& made) {
  const std::string how =
      "[tile,pyramid,bigtiff,tile-width=256,tile-height=256,compression=jpeg,Q=90]";
  const std::string times = std::to_string(picture_repeats);
  Child vips({.words = {"vips", "replicate", part, made + how, times, times}});
  if (vips.wait() != 0)
    throw std::runtime_error(made + ": vips cannot make it (Debian: libvips-tools)");
}

// Writes a box that is seen from inside, and a lamp in it.
void write_scene(const std::string& folder) {
  const vec3 low(-6, 0, -3), high(6, 4, 5);
  std::vector<float> positions;
  for (int axis = 0; axis < 3; axis++)
    for (const bool is_high : {false, true}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      auto corner = [&](bool a, bool b) {
        vec3 p(0);
        p[axis] = is_high ? high[axis] : low[axis];
        p[u] = a ? high[u] : low[u], p[v] = b ? high[v] : low[v];
        return p;
      };
      const vec3 around[] = {corner(false, false), corner(!is_high, is_high), corner(true, true),
                             corner(is_high, !is_high)};
      for (const int i : {0, 1, 2, 0, 2, 3})
        positions.insert(positions.end(), {around[i].x, around[i].y, around[i].z});
    }
  const size_t bytes = positions.size() * sizeof(float);
  std::ofstream(folder + "/scene.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(positions.data()), std::streamsize(bytes));
  const json lamp = {{"type", "point"}, {"intensity", 60}, {"name", "lamp"}};
  json scene = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  scene["extensionsUsed"] = json::array({"KHR_lights_punctual"});
  scene["extensions"]["KHR_lights_punctual"]["lights"] = json::array({lamp});
  scene["buffers"] = json::array({{{"uri", "scene.bin"}, {"byteLength", bytes}}});
  scene["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", bytes}}});
  scene["accessors"] = json::array({{{"bufferView", 0},
                                     {"componentType", 5126},
                                     {"type", "VEC3"},
                                     {"count", positions.size() / 3},
                                     {"min", {low.x, low.y, low.z}},
                                     {"max", {high.x, high.y, high.z}}}});
  scene["materials"] = json::array({{{"name", "plaster"}}});
  scene["materials"][0]["pbrMetallicRoughness"] = {{"metallicFactor", 0},
                                                   {"baseColorFactor", {0.6, 0.6, 0.6, 1}}};
  const json walls = {{"attributes", {{"POSITION", 0}}}, {"material", 0}};
  scene["meshes"] = json::array({{{"primitives", json::array({walls})}}});
  const json light = {{"KHR_lights_punctual", {{"light", 0}}}};
  scene["nodes"] =
      json::array({{{"name", "room"}, {"mesh", 0}},
                   {{"name", "lamp"}, {"translation", {0, 3.5, 2}}, {"extensions", light}}});
  scene["scenes"] = json::array({{{"nodes", {0, 1}}}});
  std::ofstream(folder + "/scene.gltf") << scene.dump(1);
}

void write_exhibit(const std::string& folder) {
  const double back = LargePictureRoom::surface - 0.02;  // without a frame it stands off so much
  const json place = {{"position", {0, LargePictureRoom::middle_height, back}}, {"yaw_deg", 180}};
  const json piece = {{"id", LargePictureRoom::piece},
                      {"kind", "picture"},
                      {"source", "picture.tif"},
                      {"width_m", LargePictureRoom::picture_width},
                      {"place", place}};
  const json door = {{"name", "door"}, {"position", {0, 1.65, 3}}};
  const json exhibit = {{"title", {{"en", "A large picture"}}},
                        {"scene", "scene.gltf"},
                        {"viewpoints", json::array({door})},
                        {"pieces", json::array({piece})}};
  std::ofstream(folder + "/exhibit.json") << exhibit.dump(1);
}

}  // namespace

LargePictureRoom::LargePictureRoom() {
  const std::string room = folder_.path() + "/" + exhibit, part = folder_.path() + "/part.ppm";
  fs::create_directories(room);
  write_part(part, width / picture_repeats, height / picture_repeats);
  make_picture(part, picture());
  fs::remove(part);
  write_scene(room);
  write_exhibit(room);
}

}  // namespace wellspring::test
