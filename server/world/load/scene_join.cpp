// SPDX-License-Identifier: Apache-2.0
#include "world/load/scene_join.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include "base/layers.h"
#include "gltf/file.h"

namespace wellspring::world {
namespace {

using nlohmann::json;

// Metres; farther than this from zero floats lose millimetres: the scene gets an origin of its own.
constexpr double far = 1000;

template <class T>
void append(std::vector<T>& list, std::vector<T>& more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()),
              std::make_move_iterator(more.end()));
}

void shift(int& index, size_t by) {
  if (index >= 0) index += int(by);
}

}  // namespace

void place_scene(Scene& scene, const ScenePlace& place) {
  if (place.is_own()) return;
  const dmat4 turn = glm::rotate(dmat4(1), place.yaw, dvec3(0, 1, 0));
  const dmat4 move =
      glm::translate(dmat4(1), place.position) * glm::scale(turn, dvec3(place.scale));
  const dvec3 old_origin = scene.origin;
  dvec3 middle = dvec3(move * dvec4(old_origin, 1));
  scene.origin = glm::length(middle) > far ? glm::round(middle) : dvec3(0);
  const dmat4 own =
      glm::translate(dmat4(1), -scene.origin) * move * glm::translate(dmat4(1), old_origin);
  for (Instance& instance : scene.instances)
    instance.to_world = mat4(own * dmat4(instance.to_world));
  for (PunctualLight& light : scene.lights) {
    light.position = vec3(own * dvec4(dvec3(light.position), 1));
    light.direction = normalize(vec3(turn * dvec4(dvec3(light.direction), 0)));
    light.range *= float(place.scale);
    if (light.type != PunctualType::directional)
      light.intensity *= float(place.scale * place.scale);
  }
  for (PlacedMotion& motion : scene.motions) motion.to_world = move * motion.to_world;
  for (Viewpoint& view : scene.viewpoints) {
    view.position = dvec3(move * dvec4(view.position, 1));
    view.yaw += float(place.yaw);
  }
}

int add_materials(Scene& into, Scene& part) {
  const size_t images = into.images.size(), textures = into.textures.size(),
               materials = into.materials.size();
  for (Texture& texture : part.textures) shift(texture.image, images);
  for (Material& material : part.materials)
    each_texture(material, [&](TextureRef& use) { shift(use.texture, textures); });
  append(into.images, part.images);
  append(into.textures, part.textures);
  append(into.materials, part.materials);
  return int(materials);
}

void join_scene(Scene& into, Scene part) {
  const vec3 offset = vec3(part.origin - into.origin);
  const size_t meshes = into.meshes.size(), objects = into.objects.size(),
               nodes = into.nodes.size(), instances = into.instances.size();
  const size_t materials = size_t(add_materials(into, part));
  for (Mesh& mesh : part.meshes) shift(mesh.material, materials);
  for (Instance& instance : part.instances) {
    shift(instance.mesh, meshes);
    instance.object += uint32_t(objects);
    instance.to_world = glm::translate(mat4(1), offset) * instance.to_world;
  }
  for (SceneNode& node : part.nodes) shift(node.parent, nodes);
  for (int& node : part.object_nodes) shift(node, nodes);
  for (int& node : part.light_nodes) shift(node, nodes);
  for (PunctualLight& light : part.lights) light.position += offset;
  for (PlacedMotion& motion : part.motions)
    for (int& instance : motion.instances) shift(instance, instances);
  append(into.meshes, part.meshes);
  append(into.instances, part.instances);
  append(into.objects, part.objects);
  append(into.nodes, part.nodes);
  append(into.object_nodes, part.object_nodes);
  append(into.light_nodes, part.light_nodes);
  append(into.lights, part.lights);
  append(into.viewpoints, part.viewpoints);
  append(into.motions, part.motions);
  append(into.warnings, part.warnings);
}

void scale_light(Scene& scene, float factor) {
  for (PunctualLight& light : scene.lights) light.intensity *= factor;
  for (Material& material : scene.materials) material.emission *= factor;
}

using namespace gltf;

std::vector<std::string> list_scene_files(const std::string& path) {
  File file = load_gltf(path, "");
  std::vector<std::string> names;
  for (const char* kind : {"buffers", "images"}) {
    const json& list = items(file.root, kind);
    for (size_t i = 0; i < list.size(); i++) {
      const std::string uri = text(list[i], "uri"), where = at(std::string("/") + kind, i);
      if (uri.empty() || is_data_uri(uri)) continue;
      const auto found = find_uri(file, where, uri);
      if (!found) continue;
      const std::string name = found->lexically_relative(file.package).string();
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

using namespace gltf;

Credit load_credit(const std::string& path, const std::string& package) {
  File file = load_gltf(path, package);
  Credit credit;
  credit.file = std::filesystem::path(path).filename().string();
  const json& asset = file.root["asset"];
  credit.copyright = text(asset, "copyright");
  const json* extras = find(asset, "extras");
  if (!extras || !extras->is_object()) return credit;
  // Extras may hold anything: values that are no texts are passed over.
  auto read = [&](const char* key) {
    const json* value = find(*extras, key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
  };
  credit.title = read("title");
  credit.author = read("author");
  credit.licence = read("license");
  if (credit.licence.empty()) credit.licence = read("licence");
  credit.source = read("source");
  return credit;
}

}  // namespace wellspring::world
