// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/bone_surface.h"

#include <algorithm>

namespace wellspring::avatar {
namespace {

void add_triangle(Character& character, Part& part, int joint, vec3 a, vec3 b, vec3 c) {
  vec3 normal = cross(b - a, c - a);
  float length = glm::length(normal);
  if (!(length > 1e-12f)) return;
  uint32_t first = uint32_t(character.positions.size());
  for (vec3 p : {a, b, c}) {
    character.positions.push_back(p);
    character.normals.push_back(normal / length);
    character.weights.push_back({uint16_t(joint), 1});
    character.first_weight.push_back(uint32_t(character.weights.size()));
  }
  part.triangles.push_back({first, first + 1, first + 2});
}

// From joint to joint, thickest at a fifth of the way.
void add_bone(Character& character, Part& part, int joint, vec3 from, vec3 to, float thickness) {
  vec3 along = to - from;
  float length = glm::length(along);
  if (!(length > 1e-4f)) return;
  along /= length;
  vec3 side =
      glm::normalize(cross(std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), along));
  vec3 up = cross(along, side), waist = from + 0.2f * length * along;
  float radius = std::min(thickness, 0.12f * length);
  vec3 ring[4] = {waist + radius * side, waist + radius * up, waist - radius * side,
                  waist - radius * up};
  for (int i = 0; i < 4; i++) {
    add_triangle(character, part, joint, from, ring[(i + 1) % 4], ring[i]);
    add_triangle(character, part, joint, to, ring[i], ring[(i + 1) % 4]);
  }
}

}  // namespace

void add_bone_surface(Character& character) {
  if (!character.parts.empty() || character.joints.empty()) return;
  character.material_file.clear();
  character.appearances.assign(1, Appearance{});
  character.appearances[0].name = "bone";
  character.appearances[0].base_color = vec3(0.75f, 0.72f, 0.64f);
  character.uv.clear(), character.second_uv.clear(), character.colors.clear();
  character.positions.clear(), character.normals.clear(), character.weights.clear();
  character.first_weight = {0};
  float low = character.joints[0].center.y, high = low;
  for (const Joint& joint : character.joints)
    low = std::min(low, joint.center.y), high = std::max(high, joint.center.y);
  float size = std::max(high - low, 0.01f);
  Part part{"bones", 0, {}};
  std::vector<char> ends(character.joints.size(), 1);
  for (size_t j = 0; j < character.joints.size(); j++) {
    int parent = character.joints[j].parent;
    if (parent < 0) continue;
    ends[size_t(parent)] = 0;
    add_bone(character, part, parent, character.joints[size_t(parent)].center,
             character.joints[j].center, 0.03f * size);
  }
  // The last bones go a little on, the way they came.
  for (size_t j = 0; j < character.joints.size(); j++) {
    int parent = character.joints[j].parent;
    if (!ends[j]) continue;
    vec3 from = character.joints[j].center;
    vec3 way = parent < 0 ? vec3(0, 1, 0) : from - character.joints[size_t(parent)].center;
    float length = glm::length(way);
    bool skull = character.joints[j].name == "skullbase";
    if (skull) way = vec3(0, 1, 0), length = 1;
    if (length > 1e-6f)
      add_bone(character, part, int(j), from, from + way / length * size * (skull ? 0.12f : 0.05f),
               0.03f * size);
  }
  character.parts.push_back(std::move(part));
}

}  // namespace wellspring::avatar
