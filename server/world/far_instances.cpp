// SPDX-License-Identifier: Apache-2.0
#include "world/far_instances.h"

#include <algorithm>
#include <cmath>

namespace wellspring::world {
namespace {

// Nearer to the origin a float's step is below a thirtieth of a millimetre.
constexpr float near_enough = 256;
// Triangles that are so many steps (2^-23 of the largest coordinate) across show none of them. Rays
// would start as far as 256 steps off them otherwise (offset_origin).
constexpr float fine_steps = 1024;
// An instance that reaches as far as a fourth of its distance gains too little.
constexpr float compact = 0.25f;
// A position's error in steps. Its corner is rounded, and so are sum and the next ray's origin, by
// half a step in each of three directions: twice 0.87. What is not apart is as inexact as its
// corners.
constexpr float apart_steps = 3, usual_steps = 8;

// Smallest across of the mesh's triangles, were they all alike: from their number and its size.
bool is_apart(const Mesh& mesh, const Bounds& box, const mat4& to_world) {
  if (mesh.triangles.empty() || !(box.low.x <= box.high.x)) return false;
  const vec3 half = 0.5f * (box.high - box.low), middle = 0.5f * (box.high + box.low);
  vec3 reach(0);  // of the box in the world
  for (int i = 0; i < 3; i++) reach += glm::abs(vec3(to_world[i])) * half[i];
  const float radius = glm::length(reach);
  const vec3 turned = mat3(to_world) * middle;
  const float largest = max_component(glm::abs(turned + vec3(to_world[3])) + reach);
  const float off = glm::length(turned) + radius;  // its farthest point from its own origin
  if (!(largest > near_enough) || !std::isfinite(largest) || off > compact * largest) return false;
  const float across = 2 * radius / std::sqrt(float(mesh.triangles.size()));
  return across < fine_steps * 0x1p-23f * largest;
}

}  // namespace

void mark_far(const Scene& scene, std::vector<PlacedMesh>& placed) {
  std::vector<Bounds> boxes(scene.meshes.size());
  std::vector<char> known(scene.meshes.size(), 0);
  bool any = false;
  for (size_t i = 0; i < scene.instances.size(); i++) {
    const Instance& instance = scene.instances[i];
    if (!(max_component(glm::abs(vec3(instance.to_world[3]))) > near_enough * 0.5f)) continue;
    const size_t mesh = size_t(instance.mesh);
    if (!known[mesh]) {
      for (const vec3& p : scene.meshes[mesh].positions)
        boxes[mesh].low = glm::min(boxes[mesh].low, p),
        boxes[mesh].high = glm::max(boxes[mesh].high, p);
      known[mesh] = 1;
    }
    placed[i].apart = is_apart(scene.meshes[mesh], boxes[mesh], instance.to_world);
    any |= placed[i].apart;
  }
  if (!any) return;
  for (PlacedMesh& one : placed) one.steps = one.apart ? apart_steps : usual_steps;
}

}  // namespace wellspring::world
