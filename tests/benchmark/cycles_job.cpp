// SPDX-License-Identifier: Apache-2.0
#include "cycles_job.h"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "base/child.h"
#include "base/load_error.h"
#include "frame/picture_file.h"

namespace wellspring::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

fs::path find_blender() {
  std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(path, folder, ':');)
    if (access((fs::path(folder) / "blender").c_str(), X_OK) == 0)
      return fs::path(folder) / "blender";
  return {};
}

json triple(vec3 v) { return json::array({v.x, v.y, v.z}); }

std::string tail_of(const fs::path& file) {
  std::ifstream in(file);
  std::string all((std::istreambuf_iterator<char>(in)), {});
  return all.size() > 2000 ? all.substr(all.size() - 2000) : all;
}

// Exit status of a program whose output goes to `log`; -1: it took too long and was ended.
int run(const std::vector<std::string>& command, const fs::path& log, double timeout_seconds) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  Child child({.words = command, .files = {{file, 1}, {file, 2}}, .apart = true});
  close(file);
  return child.wait(timeout_seconds).value_or(-1);
}

}  // namespace

bool has_blender() { return !find_blender().empty(); }

void render_by_cycles(const fs::path& script, const fs::path& scene, const View& view,
                      int max_depth, int threads, const fs::path& folder, double timeout_seconds,
                      std::vector<CyclesRender>& renders) {
  json job = {{"file", fs::absolute(scene).string()},
              {"size", {view.width, view.height}},
              {"threads", threads},
              {"max_depth", max_depth},
              {"camera",
               {{"position", triple(view.position)},
                {"forward", triple(view.forward)},
                {"up", triple(view.up)},
                {"fov", 2 * std::atan(view.tan_half_fov)}}},
              {"renders", json::array()}};
  for (size_t i = 0; i < renders.size(); i++)
    job["renders"].push_back(
        {{"samples", renders[i].samples},
         {"seed", renders[i].seed},
         {"out", (folder / ("cycles" + std::to_string(i) + ".exr")).string()}});
  fs::path file = folder / "job.json", log = folder / "blender.log";
  std::ofstream(file) << job.dump(1);
  int status = run({find_blender().string(), "-b", "--factory-startup", "--python-exit-code", "1",
                    "-P", script.string(), "--", file.string()},
                   log, timeout_seconds);
  if (status == -1) throw std::runtime_error("Cycles took too long");
  if (status != 0) throw std::runtime_error("Cycles failed: " + tail_of(log));
  json times = json::parse(std::ifstream(file.string() + ".times"));
  for (size_t i = 0; i < renders.size(); i++) {
    renders[i].seconds = times.at(i).at(0).get<double>();
    renders[i].processor_seconds = times.at(i).at(1).get<double>();
    renders[i].frame = load_linear_picture(job["renders"][i]["out"].get<std::string>());
  }
}

namespace {

bool is_shared_metal(const json& material) {
  json surface = material.value("pbrMetallicRoughness", json::object());
  json extensions = material.value("extensions", json::object());
  return surface.value("metallicFactor", 1.0) == 1 &&
         !surface.contains("metallicRoughnessTexture") &&
         surface.value("roughnessFactor", 1.0) <= roughest_shared_metal &&
         !material.contains("normalTexture") && !extensions.contains("KHR_materials_transmission");
}

}  // namespace

void write_shared_copy(const fs::path& glb, bool metals, const fs::path& out) {
  std::ifstream in(glb, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  uint32_t head[5] = {};
  if (bytes.size() > 20) std::memcpy(head, bytes.data(), 20);
  if (head[0] != 0x46546c67 || head[3] > bytes.size() - 20)
    throw LoadError(glb.string(), "", "is no binary glTF");
  json gltf = json::parse(bytes.substr(20, head[3]));
  for (json& material : gltf["materials"]) {
    json shared = {{"name", material.value("name", "")},
                   {"doubleSided", material.value("doubleSided", false)}};
    for (const char* key : {"emissiveFactor", "emissiveTexture", "alphaMode", "alphaCutoff"})
      if (material.contains(key)) shared[key] = material[key];
    json& surface = shared["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    json old = material.value("pbrMetallicRoughness", json::object());
    for (const char* key : {"baseColorFactor", "baseColorTexture"})
      if (old.contains(key)) surface[key] = old[key];
    json extensions = material.value("extensions", json::object()), kept = json::object();
    if (extensions.contains("KHR_materials_emissive_strength"))
      kept["KHR_materials_emissive_strength"] = extensions["KHR_materials_emissive_strength"];
    if (extensions.contains("KHR_materials_transmission")) {
      kept["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
      kept["KHR_materials_ior"] = extensions.value("KHR_materials_ior", json{{"ior", 1.5}});
      surface["roughnessFactor"] = 0;
    } else if (metals && is_shared_metal(material)) {
      surface["metallicFactor"] = 1;
      surface["roughnessFactor"] = old.value("roughnessFactor", 1.0);
    } else {
      kept["KHR_materials_ior"] = {{"ior", 1}};  // no gloss
      surface["roughnessFactor"] = 1;
    }
    shared["extensions"] = kept;
    material = shared;
  }
  gltf["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_materials_transmission",
                            "KHR_materials_ior", "KHR_lights_punctual"};
  gltf.erase("extensionsRequired");
  std::string text = gltf.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string rest = bytes.substr(20 + head[3]);
  head[3] = uint32_t(text.size());
  head[2] = uint32_t(20 + text.size() + rest.size());
  std::ofstream file(out, std::ios::binary);
  file.write(reinterpret_cast<const char*>(head), 20);
  file << text << rest;
  if (!file) throw LoadError(out.string(), "", "cannot be written");
}

}  // namespace wellspring::test
