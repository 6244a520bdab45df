// SPDX-License-Identifier: Apache-2.0
#include "show/moving/prop.h"

#include <algorithm>
#include <limits>

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

}  // namespace

Prop make_prop(const ExhibitProp& prop, Scene& scene, std::vector<Mesh>& moving,
               std::vector<uint32_t>& moving_object) {
  Prop made;
  Scene own = prop.scene;
  const int first_material = add_materials(scene, own);
  if (scene.objects.empty()) scene.objects.push_back("");
  const uint32_t object = uint32_t(scene.objects.size());
  scene.objects.push_back(prop.id);
  for (const Instance& instance : own.instances) {
    Mesh mesh = own.meshes[size_t(instance.mesh)];
    const mat4 to_fist = prop.to_fist * instance.to_world;
    const mat3 turn = glm::transpose(glm::inverse(mat3(to_fist)));
    for (vec3& p : mesh.positions) p = vec3(to_fist * vec4(p, 1));
    for (vec3& n : mesh.normals) n = normalize(turn * n);
    if (gltf::is_mirrored(dmat4(to_fist))) turn_winding(mesh);
    mesh.material += first_material;
    PropPart part;
    part.moving = int(moving.size());
    part.positions = mesh.positions;
    part.normals = mesh.normals;
    part.shines = scene.materials[size_t(mesh.material)].emission != vec3(0);
    if (part.shines) part.foot = foot_of(part.positions);
    part.shown = true;  // as a World has it at first
    made.parts.push_back(std::move(part));
    moving.push_back(std::move(mesh));
    moving_object.push_back(object);
  }
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
