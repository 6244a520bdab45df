// SPDX-License-Identifier: Apache-2.0
#include "show/moving/prop.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "gltf/animation.h"
#include "world/load/scene_join.h"
#include "world/mesh_finish.h"

namespace wellspring::show {
namespace {

// The lowest of it, in the middle.
vec3 foot_of(const std::vector<vec3>& positions) {
  vec3 low(std::numeric_limits<float>::infinity()), high = -low;
  for (const vec3& p : positions) low = min(low, p), high = max(high, p);
  return {0.5f * (low.x + high.x), low.y, 0.5f * (low.z + high.z)};
}

uint32_t add_object(const std::string& name, Scene& scene) {
  if (scene.objects.empty()) scene.objects.push_back("");
  scene.objects.push_back(name);
  return uint32_t(scene.objects.size() - 1);
}

// Adds a mesh that `to_own` takes to the thing's own frame; its material is one of the scene's.
void add_part(Mesh mesh, const mat4& to_own, const Scene& scene, uint32_t object, Prop& to,
              std::vector<Mesh>& moving, std::vector<uint32_t>& moving_object) {
  const mat3 turn = glm::transpose(glm::inverse(mat3(to_own)));
  for (vec3& p : mesh.positions) p = vec3(to_own * vec4(p, 1));
  for (vec3& n : mesh.normals) n = normalize(turn * n);
  if (gltf::is_mirrored(dmat4(to_own))) turn_winding(mesh);
  PropPart part;
  part.moving = int(moving.size());
  part.positions = mesh.positions;
  part.normals = mesh.normals;
  part.shines = scene.materials[size_t(mesh.material)].emission != vec3(0);
  if (part.shines) part.foot = foot_of(part.positions);
  part.shown = true;  // as a World has it at first
  to.parts.push_back(std::move(part));
  moving.push_back(std::move(mesh));
  moving_object.push_back(object);
}

constexpr float longest_held = 0.3f;  // metres
constexpr size_t most_held_triangles = 20'000;

// A thing to be held: meshes of a scene, each with what takes it to the thing's own axes.
struct HeldMeshes {
  std::vector<std::pair<int, mat4>> meshes;
  size_t triangles = 0;
  Bounds bounds;

  void add(const Scene& scene, int mesh, const mat4& to_own) {
    meshes.emplace_back(mesh, to_own);
    triangles += scene.meshes[size_t(mesh)].triangles.size();
    for (const vec3& p : scene.meshes[size_t(mesh)].positions) {
      const vec3 at(to_own * vec4(p, 1));
      bounds.low = min(bounds.low, at), bounds.high = max(bounds.high, at);
    }
  }
  bool fits() const { return !meshes.empty() && triangles <= most_held_triangles; }
  // Puts its middle at 0 and makes it small enough to be held.
  mat4 to_hand() const {
    const vec3 size = bounds.high - bounds.low;
    const float scale = std::min(1.0f, longest_held / std::max(max_component(size), 1e-6f));
    return glm::translate(glm::scale(mat4(1), vec3(scale)), -0.5f * (bounds.low + bounds.high));
  }
};

// Takes an object of the exhibit's scene from where it stands to its node's axes, in metres.
HeldMeshes meshes_of(const Scene& scene, const PointOfInterest& point) {
  HeldMeshes out;
  std::optional<mat4> to_own;
  for (const Instance& instance : scene.instances) {
    if (std::ranges::find(point.objects, instance.object) == point.objects.end()) continue;
    if (!to_own) {
      mat3 axes(instance.to_world);
      for (int i = 0; i < 3; i++) axes[i] = normalize(axes[i]);
      to_own = mat4(glm::transpose(axes));
    }
    out.add(scene, instance.mesh, *to_own * instance.to_world);
  }
  return out;
}

}  // namespace

Prop make_prop(const ExhibitProp& prop, Scene& scene, std::vector<Mesh>& moving,
               std::vector<uint32_t>& moving_object) {
  Prop made;
  Scene own = prop.scene;
  const int first_material = add_materials(scene, own);
  const uint32_t object = add_object(prop.id, scene);
  for (const Instance& instance : own.instances) {
    Mesh mesh = own.meshes[size_t(instance.mesh)];
    mesh.material += first_material;
    add_part(std::move(mesh), prop.to_fist * instance.to_world, scene, object, made, moving,
             moving_object);
  }
  return made;
}

Prop make_held_model(const Exhibit& exhibit, const std::string& id, Scene& scene,
                     std::vector<Mesh>& moving, std::vector<uint32_t>& moving_object) {
  Prop made;
  if (const int found = find_prop(exhibit, id); found >= 0) {
    ExhibitProp prop = exhibit.props[size_t(found)];
    HeldMeshes all;
    for (const Instance& instance : prop.scene.instances)
      all.add(prop.scene, instance.mesh, instance.to_world);
    prop.to_fist = all.to_hand();
    return all.fits() ? make_prop(prop, scene, moving, moving_object) : made;
  }
  const PointOfInterest* point = find_point(exhibit, id);
  const HeldMeshes all = point ? meshes_of(exhibit.scene, *point) : HeldMeshes{};
  if (!all.fits()) return made;
  const uint32_t object = add_object(id, scene);
  for (const auto& [mesh, to_own] : all.meshes)
    add_part(scene.meshes[size_t(mesh)], all.to_hand() * to_own, scene, object, made, moving,
             moving_object);
  return made;
}

bool pose_prop(World& world, Prop& prop, const PropPose& pose) {
  bool changed = false;
  for (PropPart& part : prop.parts) {
    const float flame = part.shines ? pose.flame : 1;
    const bool shown = pose.size > 0 && flame > 0;
    if (shown != part.shown) {
      world.show(part.moving, shown);
      part.shown = shown;
      changed = true;
    }
    if (!shown) continue;
    mat4 to_world = glm::scale(pose.to_world, vec3(pose.size));
    if (part.shines) {
      // A high flame is a little wider than a low one.
      const vec3 grown(0.5f + 0.5f * std::min(flame, 1.0f), flame,
                       0.5f + 0.5f * std::min(flame, 1.0f));
      to_world = glm::translate(glm::scale(glm::translate(to_world, part.foot), grown), -part.foot);
    }
    const mat3 turn = glm::transpose(glm::inverse(mat3(to_world)));
    prop.positions.resize(part.positions.size());
    prop.normals.resize(part.normals.size());
    for (size_t i = 0; i < part.positions.size(); i++) {
      prop.positions[i] = vec3(to_world * vec4(part.positions[i], 1));
      prop.normals[i] = normalize(turn * part.normals[i]);
    }
    world.move(part.moving, prop.positions, prop.normals);
    changed = true;
  }
  return changed;
}

}  // namespace wellspring::show
