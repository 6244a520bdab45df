// SPDX-License-Identifier: Apache-2.0
#include "show/exhibit/exhibit_objects.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "base/near_name.h"

namespace wellspring::show {

namespace {

constexpr double largest_around = 1.5;  // metres: half of what is looked at from all sides

// Of each node of the scene: does it, or one above it, have that number?
bool is_below(const Scene& scene, int node, int above) {
  for (size_t steps = 0; node >= 0 && steps <= scene.nodes.size(); steps++) {
    if (node == above) return true;
    node = scene.nodes[size_t(node)].parent;
  }
  return false;
}

// Objects of that name; else those below the first node of that name.
std::vector<uint32_t> find_objects(const Scene& scene, const std::string& name) {
  std::vector<uint32_t> found;
  if (name.empty()) return found;
  auto object = std::find(scene.objects.begin(), scene.objects.end(), name);
  if (object != scene.objects.end()) return {uint32_t(object - scene.objects.begin())};
  for (size_t node = 0; node < scene.nodes.size(); node++) {
    if (scene.nodes[node].name != name) continue;
    for (uint32_t i = 1; i < scene.object_nodes.size(); i++)
      if (is_below(scene, scene.object_nodes[i], int(node))) found.push_back(i);
    if (!found.empty()) break;
  }
  return found;
}

// Of all that belongs to the objects, relative to the scene's origin; empty: low above high.
Bounds bounds_of(const Scene& scene, const std::vector<uint32_t>& objects) {
  Bounds bounds;
  for (const Instance& instance : scene.instances) {
    if (std::find(objects.begin(), objects.end(), instance.object) == objects.end()) continue;
    for (vec3 position : scene.meshes[size_t(instance.mesh)].positions) {
      vec3 p = vec3(instance.to_world * vec4(position, 1));
      bounds.low = min(bounds.low, p);
      bounds.high = max(bounds.high, p);
    }
  }
  return bounds;
}

std::string no_node(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (const SceneNode& node : scene.nodes) names.push_back(node.name);
  names.insert(names.end(), scene.objects.begin(), scene.objects.end());
  if (!name.empty() && std::find(names.begin(), names.end(), name) != names.end())
    return "nothing that can be seen belongs to the node '" + name + "'";
  return "the scene has no node '" + name + "'" + did_you_mean(name, names);
}

bool is_address(const std::string& text) {
  return text.starts_with("https://") && text.size() > 8 &&
         text.find_first_of(" \t\n\"<>") == std::string::npos;
}

// What is told of it.
void read_label(const Exhibit& exhibit, PointOfInterest& point, Fields& fields) {
  point.title = fields.local_text("title", false);
  point.text = fields.local_text("text", false);
  point.story = fields.text("story", false);
  const bool known = std::ranges::any_of(
      exhibit.stories, [&](const StoryText& story) { return story.id == point.story; });
  if (!point.story.empty() && !known)
    fields.problem("story", "there is no story '" + point.story + "'");
  fields.object("provenance", false, [&](Fields facts) {
    for (const std::string& name : facts.names()) {
      if (std::ranges::find(provenance_elements, name) == std::end(provenance_elements))
        facts.problem(name, "is none of the fifteen elements of the Dublin Core", false);
      else point.provenance[name] = facts.local_text(name.c_str(), true);
    }
  });
  point.manifest = fields.text("manifest", false);
  if (!point.manifest.empty() && !is_address(point.manifest))
    fields.problem("manifest", "must be an address that begins with https://");
  point.around = fields.flag("around", false);
  fields.object("door", false, [&](Fields door) {
    point.door.exhibit = door.text("exhibit", true);
    point.door.viewpoint = door.text("viewpoint", false);
    if (!std::filesystem::exists(exhibit.folder + "/../" + point.door.exhibit + "/exhibit.json"))
      door.problem("exhibit", "there is no exhibit '" + point.door.exhibit + "' beside this one",
                   false);
    door.finish();
  });
}

}  // namespace

void read_objects(Exhibit& exhibit, Fields& root) {
  const Scene& scene = exhibit.scene;
  root.members("objects", [&](const std::string& id, Fields fields) {
    PointOfInterest point;
    point.id = id;
    point.node = fields.text("node", true);
    read_label(exhibit, point, fields);
    point.objects = find_objects(scene, point.node);
    if (point.objects.empty() && !scene.objects.empty())
      fields.problem("node", no_node(scene, point.node));
    const Bounds bounds = bounds_of(scene, point.objects);
    const bool empty = !(bounds.low.x <= bounds.high.x);
    const vec3 size = empty ? vec3(0) : bounds.high - bounds.low;
    if (point.around && 0.5 * double(glm::length(size)) > largest_around)
      fields.problem("around",
                     fmt::format("is for things up to {:g} m; this is {:.3g} m from end "
                                 "to end",
                                 2 * largest_around, glm::length(size)),
                     false);
    dvec3 middle = scene.origin + (empty ? dvec3(0) : dvec3(0.5f * (bounds.low + bounds.high)));
    point.place = fields.triple("at", false, middle);
    fields.finish();
    exhibit.points.push_back(std::move(point));
  });
}

}  // namespace wellspring::show
