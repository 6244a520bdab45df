// SPDX-License-Identifier: Apache-2.0
#include "world/load/lamp.h"

#include <algorithm>
#include <map>

#include "base/unicode.h"

namespace wellspring::world {
namespace {

bool has(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

const Lamp* owner_of_light(const Scene& scene, int light) {
  const int lamp = lamp_of_light(scene, light);
  return lamp < 0 ? nullptr : &scene.lamps[size_t(lamp)];
}

const Lamp* owner_of_material(const Scene& scene, int material) {
  for (const Lamp& lamp : scene.lamps)
    if (has(lamp.materials, material)) return &lamp;
  return nullptr;
}

int material_of(const Scene& scene, const Instance& instance) {
  return scene.meshes[size_t(instance.mesh)].material;
}

bool emits(const Material& material) {
  return material.unlit || max_component(material.emission) > 0;
}

// Returns for each node of the scene whether it or one above it has that name.
std::vector<char> nodes_within(const Scene& scene, const std::string& name) {
  constexpr char unknown = 2;
  std::vector<char> within(scene.nodes.size(), unknown);
  std::vector<size_t> way;
  for (size_t i = 0; i < scene.nodes.size(); i++) {
    char answer = 0;
    for (int at = int(i); at >= 0; at = scene.nodes[size_t(at)].parent) {
      if (within[size_t(at)] == unknown && scene.nodes[size_t(at)].name != name) {
        way.push_back(size_t(at));
        continue;
      }
      answer = within[size_t(at)] = within[size_t(at)] == unknown ? 1 : within[size_t(at)];
      break;
    }
    for (size_t passed : way) within[passed] = answer;
    way.clear();
  }
  return within;
}

// Returns whether the light or object of this number comes from such a node.
bool is_within(const std::vector<char>& within, const std::vector<int>& nodes, size_t number) {
  return number < nodes.size() && nodes[number] >= 0 && within[size_t(nodes[number])];
}

std::vector<int> lights_within(const Scene& scene, const std::vector<char>& within,
                               const std::string& name) {
  std::vector<int> lights;
  for (size_t i = 0; i < scene.lights.size(); i++)
    if (scene.lights[i].name == name || is_within(within, scene.light_nodes, i))
      lights.push_back(int(i));
  return lights;
}

// Gathers the parts of a lamp that one name means, and the faults of that name.
struct Gathered {
  std::vector<int> lights;
  std::vector<size_t> instances;
  bool exists = false, emits = false;
  const Lamp* taken = nullptr;

  void add_light(const Scene& scene, int light) {
    exists = emits = true;
    if (const Lamp* owner = owner_of_light(scene, light)) taken = owner;
    else if (!has(lights, light)) lights.push_back(light);
  }
  void add_instance(const Scene& scene, size_t instance) {
    exists = true;
    int material = material_of(scene, scene.instances[instance]);
    if (!wellspring::light::emits(scene.materials[size_t(material)])) return;
    emits = true;
    if (const Lamp* owner = owner_of_material(scene, material)) taken = owner;
    else instances.push_back(instance);
  }
  std::string fault(const std::string& kind, const std::string& name) const {
    if (!exists) return "the scene has no " + kind + " '" + name + "'";
    if (!emits) return "nothing of the " + kind + " '" + name + "' shines";
    return taken ? "'" + name + "' belongs to the lamp '" + taken->name + "'" : "";
  }
};

// Gives the instances of one material to the lamp, with a material and meshes of their own.
void take_instances(const std::vector<size_t>& instances, int material, Scene& scene, Lamp& lamp) {
  std::vector<char> taken(scene.instances.size(), 0);
  for (size_t i : instances) taken[i] = 1;
  std::vector<char> shared_mesh(scene.meshes.size(), 0);
  bool shared = false;
  for (size_t i = 0; i < scene.instances.size(); i++) {
    if (taken[i]) continue;
    shared_mesh[size_t(scene.instances[i].mesh)] = 1;
    shared |= material_of(scene, scene.instances[i]) == material;
  }
  int own = material;
  if (shared) {
    own = int(scene.materials.size());
    scene.materials.push_back(Material(scene.materials[size_t(material)]));
  }
  lamp.materials.push_back(own);
  std::map<int, int> own_mesh;
  for (size_t i : instances) {
    int& mesh = scene.instances[i].mesh;
    if (shared_mesh[size_t(mesh)]) {
      auto [found, made] = own_mesh.try_emplace(mesh, int(scene.meshes.size()));
      if (made) scene.meshes.push_back(Mesh(scene.meshes[size_t(mesh)]));
      mesh = found->second;
      if (made) shared_mesh.push_back(0);
    }
    scene.meshes[size_t(mesh)].material = own;
  }
}

std::vector<std::string> names_in(const Scene& scene, bool of_materials) {
  std::vector<std::string> names;
  if (of_materials)
    for (const Material& material : scene.materials) names.push_back(material.name);
  else
    for (const SceneNode& node : scene.nodes) names.push_back(node.name);
  return names;
}

}  // namespace

std::vector<LampFault> add_lamp(const LampNames& names, Scene& scene) {
  std::vector<LampFault> faults;
  Lamp lamp;
  lamp.name = names.name;
  std::vector<size_t> instances;
  auto take = [&](const Gathered& found, bool is_material, size_t index, const std::string& name) {
    std::string fault = found.fault(is_material ? "material" : "node", name);
    if (!found.exists) fault += did_you_mean(name, names_in(scene, is_material));
    if (!fault.empty()) faults.push_back({is_material, index, fault});
    for (int light : found.lights)
      if (!has(lamp.lights, light)) lamp.lights.push_back(light);
    instances.insert(instances.end(), found.instances.begin(), found.instances.end());
  };
  for (size_t n = 0; n < names.nodes.size(); n++) {
    const std::string& name = names.nodes[n];
    Gathered found;
    if (name.empty()) continue;
    std::vector<char> within = nodes_within(scene, name);
    found.exists = std::find(within.begin(), within.end(), 1) != within.end();
    for (int light : lights_within(scene, within, name)) found.add_light(scene, light);
    for (size_t i = 0; i < scene.instances.size(); i++) {
      uint32_t object = scene.instances[i].object;
      bool named = object < scene.objects.size() && scene.objects[object] == name;
      if (named || is_within(within, scene.object_nodes, object)) found.add_instance(scene, i);
    }
    take(found, false, n, name);
  }
  for (size_t n = 0; n < names.materials.size(); n++) {
    Gathered found;
    for (size_t i = 0; i < scene.instances.size(); i++)
      if (scene.materials[size_t(material_of(scene, scene.instances[i]))].name ==
          names.materials[n])
        found.add_instance(scene, i);
    take(found, true, n, names.materials[n]);
  }
  std::sort(instances.begin(), instances.end());
  instances.erase(std::unique(instances.begin(), instances.end()), instances.end());
  std::map<int, std::vector<size_t>> by_material;
  for (size_t i : instances) by_material[material_of(scene, scene.instances[i])].push_back(i);
  for (const auto& [material, of_it] : by_material) take_instances(of_it, material, scene, lamp);
  scene.lamps.push_back(std::move(lamp));
  return faults;
}

std::vector<int> find_lights(const Scene& scene, const std::string& node, std::string& fault) {
  const std::vector<char> within = nodes_within(scene, node);
  std::vector<int> lights = lights_within(scene, within, node);
  if (!lights.empty()) return lights;
  const bool exists = std::find(within.begin(), within.end(), 1) != within.end();
  fault = exists
              ? "nothing of the node '" + node + "' is a point, spot or distant light"
              : "the scene has no node '" + node + "'" + did_you_mean(node, names_in(scene, false));
  return {};
}

int lamp_of_light(const Scene& scene, int light) {
  for (size_t lamp = 0; lamp < scene.lamps.size(); lamp++)
    if (has(scene.lamps[lamp].lights, light)) return int(lamp);
  return -1;
}

std::optional<LampSwitch> find_switch(const Scene& scene, const Lamp& lamp, const std::string& word,
                                      std::string& states) {
  if (word == "on" || word == "off") return LampSwitch(word == "on");
  states = "on, off";
  for (size_t i = 0; i < lamp.dial.size(); i++) {
    const std::string& light = scene.spectra[size_t(lamp.dial[i].spectrum)].name;
    if (light == word) return LampSwitch(i + 2);
    states += ", " + light;
  }
  return {};
}

void remove_lights(std::span<const int> lights, Scene& scene) {
  std::vector<int> becomes(scene.lights.size(), 0);
  for (int light : lights) becomes[size_t(light)] = -1;
  int kept = 0;
  for (size_t i = 0; i < becomes.size(); i++) {
    if (becomes[i] < 0) continue;
    if (size_t(kept) != i) scene.lights[size_t(kept)] = std::move(scene.lights[i]);
    if (i < scene.light_nodes.size()) scene.light_nodes[size_t(kept)] = scene.light_nodes[i];
    becomes[i] = kept++;
  }
  scene.lights.resize(size_t(kept));
  scene.light_nodes.resize(std::min(scene.light_nodes.size(), size_t(kept)));
  for (Lamp& lamp : scene.lamps) {
    std::erase_if(lamp.lights, [&](int light) { return becomes[size_t(light)] < 0; });
    for (int& light : lamp.lights) light = becomes[size_t(light)];
  }
}

}  // namespace wellspring::world
