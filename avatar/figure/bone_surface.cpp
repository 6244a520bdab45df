// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/bone_surface.h"

#include <algorithm>
#include <cmath>

#include "avatar/figure/bone_names.h"

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

// Adds a bone from joint to joint, thickest at a fifth of the way.
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
  // The last bones go on a little in the same direction.
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

// Knows a person's skeleton by its shape: two like legs that reach the floor, above them two like
// arms and something between.

namespace {

struct Shape {
  const std::vector<Bone>& bones;
  std::vector<std::vector<int>> children;
  std::vector<float> low, high;  // least and greatest y of each bone and all below it
  // number of bones below and length of their longest chain, the bone itself included
  std::vector<int> size, depth;
  float height = 0;

  explicit Shape(const std::vector<Bone>& from) : bones(from), children(from.size()) {
    size_t n = bones.size();
    low.resize(n), high.resize(n), size.assign(n, 1), depth.assign(n, 1);
    for (size_t i = 0; i < n; i++) low[i] = high[i] = bones[i].place.y;
    float bottom = 1e30f, top = -1e30f;
    for (size_t i = n; i-- > 0;) {
      bottom = std::min(bottom, low[i]), top = std::max(top, high[i]);
      int parent = bones[i].parent;
      if (parent < 0) continue;
      size_t p = size_t(parent);
      children[p].insert(children[p].begin(), int(i));
      low[p] = std::min(low[p], low[i]), high[p] = std::max(high[p], high[i]);
      size[p] += size[i], depth[p] = std::max(depth[p], depth[i] + 1);
    }
    height = std::max(top - bottom, 0.0f);
  }
  vec3 place(int bone) const { return bones[size_t(bone)].place; }

  // Returns the longest chain from a bone; it ends where a hand spreads.
  std::vector<int> chain(int bone) const {
    std::vector<int> result;
    while (bone >= 0) {
      result.push_back(bone);
      int next = -1;
      if (children[size_t(bone)].size() < 3)
        for (int child : children[size_t(bone)])
          if (next < 0 || depth[size_t(child)] > depth[size_t(next)]) next = child;
      bone = next;
    }
    return result;
  }

  struct Pair {
    int parent = -1, a = -1, b = -1;
  };
  // Finds pairs of children with as many bones each whose ends lie level and apart.
  template <class Fits>
  std::vector<Pair> like_pairs(int parent, const Fits& fits) const {
    std::vector<Pair> pairs;
    const std::vector<int>& list = children[size_t(parent)];
    for (size_t i = 0; i < list.size() && i < 40; i++)
      for (size_t k = i + 1; k < list.size() && k < 40; k++) {
        std::vector<int> a = chain(list[i]), b = chain(list[k]);
        if (a.size() != b.size()) continue;
        vec3 end_a = place(a.back()), end_b = place(b.back());
        float apart = glm::length(vec2(end_a.x - end_b.x, end_a.z - end_b.z));
        bool level = std::abs(end_a.y - end_b.y) < 0.12f * height && apart > 0.04f * height;
        if (level && fits(a, b)) pairs.push_back({parent, list[i], list[k]});
      }
    return pairs;
  }
};

}  // namespace

std::vector<std::string> name_bones_by_shape(const std::vector<Bone>& bones) {
  std::vector<std::string> names(bones.size());
  Shape shape(bones);
  if (!(shape.height > 1e-6f) || !std::isfinite(shape.height)) return names;

  Shape::Pair legs;
  float deepest = 0.25f * shape.height;
  for (size_t i = 0; i < bones.size(); i++)
    for (const Shape::Pair& pair :
         shape.like_pairs(int(i), [&](auto&a, auto&) { return a.size() >= 3; })) {
      float drop =
          bones[i].place.y - std::max(shape.low[size_t(pair.a)], shape.low[size_t(pair.b)]);
      if (drop > deepest) deepest = drop, legs = pair;
    }
  if (legs.parent < 0) return names;

  // The spine goes up from the hips along what reaches highest, to where two arms part.
  std::vector<int> spine;
  Shape::Pair arms;
  int at = legs.parent;
  while (arms.parent < 0) {
    int up = -1;
    for (int child : shape.children[size_t(at)])
      if (child != legs.a && child != legs.b &&
          (up < 0 || shape.high[size_t(child)] > shape.high[size_t(up)]))
        up = child;
    if (up < 0) return names;
    spine.push_back(at = up);
    auto fits = [&](const std::vector<int>& a, const std::vector<int>&) { return a.size() >= 2; };
    float widest = 0;
    for (const Shape::Pair& pair : shape.like_pairs(at, fits)) {
      vec3 a = shape.place(shape.chain(pair.a).back()), b = shape.place(shape.chain(pair.b).back());
      float apart = glm::length(vec2(a.x - b.x, a.z - b.z));
      if (apart > widest) widest = apart, arms = pair;
    }
  }

  // Feet point ahead, which tells left from right.
  std::vector<int> leg_a = shape.chain(legs.a), leg_b = shape.chain(legs.b);
  vec3 ahead(0);
  for (const auto& leg : {leg_a, leg_b})
    if (leg.size() >= 4) ahead += shape.place(leg.back()) - shape.place(leg[2]);
  ahead.y = 0;
  if (!(glm::length(ahead) > 0.01f * shape.height)) ahead = vec3(0, 0, 1);
  vec3 left = cross(vec3(0, 1, 0), ahead);
  vec3 across = shape.place(legs.a) - shape.place(legs.b) +
                (shape.place(leg_a.back()) - shape.place(leg_b.back()));
  bool a_left = dot(across, left) > 0;
  across = shape.place(shape.chain(arms.a).back()) - shape.place(shape.chain(arms.b).back());
  bool arm_a_left = dot(across, left) > 0;

  auto name_chain = [&](const std::vector<int>& chain, bool is_left,
                        std::vector<const char*> joints) {
    for (size_t k = 0; k < std::min(chain.size(), joints.size()); k++)
      names[size_t(chain[k])] = (is_left ? "l_" : "r_") + std::string(joints[k]);
  };
  names[size_t(legs.parent)] = "humanoid_root";
  for (auto [bone, is_left] : {std::pair(legs.a, a_left), std::pair(legs.b, !a_left)})
    name_chain(shape.chain(bone), is_left, {"hip", "knee", "talocrural", "metatarsophalangeal_2"});
  for (auto [bone, is_left] : {std::pair(arms.a, arm_a_left), std::pair(arms.b, !arm_a_left)}) {
    std::vector<int> chain = shape.chain(bone);
    if (chain.size() >= 4)
      name_chain(chain, is_left, {"sternoclavicular", "shoulder", "elbow", "radiocarpal"});
    else name_chain(chain, is_left, {"shoulder", "elbow", "radiocarpal"});
  }
  std::vector<std::string> vertebrae = spine_names(spine.size());
  for (size_t k = 0; k < vertebrae.size(); k++) names[size_t(spine[k])] = vertebrae[k];
  int neck_foot = -1;
  for (int child : shape.children[size_t(arms.parent)])
    if (child != arms.a && child != arms.b &&
        (neck_foot < 0 || shape.high[size_t(child)] > shape.high[size_t(neck_foot)]))
      neck_foot = child;
  if (neck_foot < 0) return names;
  std::vector<int> neck = shape.chain(neck_foot);
  names[size_t(neck.back())] = "skullbase";
  neck.pop_back();
  vertebrae = neck_names(neck.size());
  for (size_t k = 0; k < vertebrae.size(); k++) names[size_t(neck[k])] = vertebrae[k];
  return names;
}

}  // namespace wellspring::avatar
