// SPDX-License-Identifier: Apache-2.0
#include "avatar_made.h"

#include <cmath>

namespace wellspring::test {
namespace {

struct Bone {
  const char *name, *parent;
  vec3 place, end;
  float radius;
};
const Bone bones[] = {
    {"humanoid_root", "", {0, 0.95f, 0}, {0, 1.08f, 0}, 0.14f},
    {"vl5", "humanoid_root", {0, 1.05f, 0}, {0, 1.22f, 0}, 0.13f},
    {"vt6", "vl5", {0, 1.2f, 0}, {0, 1.44f, 0}, 0.14f},
    {"vc4", "vt6", {0, 1.45f, 0}, {0, 1.53f, 0}, 0.05f},
    {"skullbase", "vc4", {0, 1.52f, 0}, {0, 1.75f, 0.02f}, 0.09f},
    {"l_shoulder", "vt6", {0.18f, 1.4f, 0}, {0.45f, 1.4f, 0}, 0.05f},
    {"l_elbow", "l_shoulder", {0.45f, 1.4f, 0}, {0.7f, 1.4f, 0}, 0.04f},
    {"l_radiocarpal", "l_elbow", {0.7f, 1.4f, 0}, {0.85f, 1.4f, 0}, 0.03f},
    {"r_shoulder", "vt6", {-0.18f, 1.4f, 0}, {-0.45f, 1.4f, 0}, 0.05f},
    {"r_elbow", "r_shoulder", {-0.45f, 1.4f, 0}, {-0.7f, 1.4f, 0}, 0.04f},
    {"r_radiocarpal", "r_elbow", {-0.7f, 1.4f, 0}, {-0.85f, 1.4f, 0}, 0.03f},
    {"l_hip", "humanoid_root", {0.09f, 0.92f, 0}, {0.09f, 0.5f, 0.01f}, 0.08f},
    {"l_knee", "l_hip", {0.09f, 0.5f, 0.01f}, {0.09f, 0.09f, 0}, 0.06f},
    {"l_talocrural", "l_knee", {0.09f, 0.09f, 0}, {0.09f, 0.02f, 0.15f}, 0.04f},
    {"r_hip", "humanoid_root", {-0.09f, 0.92f, 0}, {-0.09f, 0.5f, 0.01f}, 0.08f},
    {"r_knee", "r_hip", {-0.09f, 0.5f, 0.01f}, {-0.09f, 0.09f, 0}, 0.06f},
    {"r_talocrural", "r_knee", {-0.09f, 0.09f, 0}, {-0.09f, 0.02f, 0.15f}, 0.04f}};

struct Maker {
  Character& character;

  int add_joint(const std::string& name, int parent, vec3 center) {
    Joint joint;
    joint.name = name, joint.parent = parent, joint.center = center;
    character.joints.push_back(joint);
    return int(character.joints.size()) - 1;
  }

  // A tube of `rings` times `sides` quads; each ring follows `from` less and `to` more.
  void add_tube(Part& part, vec3 a, vec3 b, float radius, int rings, int sides, int from, int to) {
    uint32_t first = uint32_t(character.positions.size());
    vec3 along = glm::normalize(b - a);
    vec3 x = glm::normalize(cross(along, std::abs(along.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 0, 1))),
         y = cross(along, x);
    for (int r = 0; r <= rings; r++)
      for (int s = 0; s <= sides; s++) {
        float u = float(s) / float(sides), v = float(r) / float(rings);
        vec3 out = std::cos(2 * pi * u) * x + std::sin(2 * pi * u) * y;
        float width = radius * (1 - 0.9f * std::pow(2 * v - 1, 4.0f));
        character.positions.push_back(glm::mix(a, b, v) + out * width);
        character.normals.push_back(out);
        character.uv.push_back({u, v});
        if (to != from) character.weights.push_back({uint16_t(to), v});
        character.weights.push_back({uint16_t(from), to == from ? 1 : 1 - v});
        character.first_weight.push_back(uint32_t(character.weights.size()));
      }
    uint32_t row = uint32_t(sides) + 1;
    for (uint32_t r = 0; r < uint32_t(rings); r++)
      for (uint32_t s = 0; s < uint32_t(sides); s++) {
        uint32_t i = first + r * row + s;
        part.triangles.push_back({i, i + 1, i + row});
        part.triangles.push_back({i + 1, i + row + 1, i + row});
      }
  }

  // A row of joints that hang below `top`.
  void add_strand(Part& part, const std::string& name, int parent, vec3 top, vec3 step, int count,
                  float radius, bool swings) {
    int above = parent;
    for (int i = 0; i < count; i++) {
      vec3 place = top + step * float(i);
      int joint = add_joint(name + "_" + std::to_string(i), above, place);
      add_tube(part, place, place + step, radius, 3, 6, joint, joint);
      if (swings) {
        SpringBone bone;
        bone.joint = joint, bone.tail = step, bone.stiffness = 0.6f, bone.drag = 0.4f,
        bone.radius = 0.01f;
        bone.gravity = vec3(0, -0.1f, 0);
        for (int c = 0; c < 8; c++) bone.colliders.push_back(c);
        character.springs.push_back(bone);
      }
      above = joint;
    }
  }
};

void add_colliders(Character& character) {
  for (const char* name :
       {"skullbase", "vt6", "vl5", "humanoid_root", "l_hip", "r_hip", "l_shoulder", "r_shoulder"})
    for (const Bone& bone : bones)
      if (std::string(name) == bone.name) {
        SpringCollider collider;
        collider.joint = find_joint(character, name);
        collider.place = bone.place, collider.tail = bone.end, collider.radius = 0.9f * bone.radius;
        character.spring_colliders.push_back(collider);
      }
}

// Shapes of the face, each of all the head's vertices.
void add_shapes(Character& character, uint32_t first, uint32_t end) {
  for (const char* name :
       {"blink_l", "blink_r", "smile_l", "smile_r", "brow_up_l", "brow_up_r", "mouth_open", "happy",
        "viseme_PP", "viseme_FF", "viseme_aa", "viseme_E", "viseme_ih", "viseme_oh", "viseme_ou"}) {
    Displacer shape{name, {}, {}};
    for (uint32_t v = first; v < end; v++) {
      shape.vertices.push_back(v);
      shape.displacements.push_back(0.002f * std::sin(40 * character.positions[v].y) *
                                    character.normals[v]);
    }
    character.displacers.push_back(shape);
  }
}

}  // namespace

Character make_avatar(const MadeAvatar& what, const std::string& normals) {
  Character character;
  character.name = "made avatar";
  character.first_weight = {0};
  Appearance look;
  look.name = "skin";
  if (what.normal_map) look.normal_texture = normals;
  character.appearances = {look, look, look};
  Part body{"body", 0, {}}, head{"head", 1, {}}, hair{"hair", 2, {}};
  Maker maker{character};
  for (const Bone& bone : bones)
    maker.add_joint(bone.name, find_joint(character, bone.parent), bone.place);
  uint32_t face_first = 0, face_end = 0;
  for (size_t i = 0; i < std::size(bones); i++) {
    bool face = i == 4;
    int joint = int(i), parent = character.joints[i].parent;
    if (face) face_first = uint32_t(character.positions.size());
    maker.add_tube(face ? head : body, bones[i].place, bones[i].end, bones[i].radius,
                   face ? 40 : 16, face ? 40 : 16, parent < 0 ? joint : parent, joint);
    if (face) face_end = uint32_t(character.positions.size());
  }
  for (int k = 0; k < 24; k++) {  // hair
    float angle = pi * (0.1f + 1.8f * float(k) / 23) - pi / 2 - pi;
    vec3 out(std::cos(angle), 0, std::sin(angle));
    maker.add_strand(hair, "hair" + std::to_string(k), find_joint(character, "skullbase"),
                     vec3(0, 1.68f, 0) + 0.1f * out, vec3(0, -0.06f, 0) + 0.004f * out, 6, 0.012f,
                     what.springs);
  }
  for (int k = 0; k < 16; k++) {  // skirt
    float angle = 2 * pi * float(k) / 16;
    vec3 out(std::cos(angle), 0, std::sin(angle));
    maker.add_strand(hair, "skirt" + std::to_string(k), 0, vec3(0, 1, 0) + 0.16f * out,
                     vec3(0, -0.1f, 0) + 0.02f * out, 4, 0.03f, what.springs);
  }
  if (what.springs) add_colliders(character);
  add_shapes(character, face_first, face_end);
  for (const char* side : {"l_", "r_"})  // two of each forearm and thigh
    for (const char* of : {"elbow", "hip"})
      for (int k = 0; k < 2; k++) {
        int source = find_joint(character, std::string(side) + of);
        vec3 place = character.joints[size_t(source)].center;
        int twist =
            maker.add_joint(std::string(side) + of + "_twist" + std::to_string(k), source, place);
        if (!what.constraints) continue;
        JointConstraint roll;
        roll.joint = twist, roll.source = source, roll.kind = JointConstraint::Kind::roll;
        roll.weight = 0.3f * float(k + 1), roll.axis = vec3(1, 0, 0);
        character.constraints.push_back(roll);
      }
  character.parts = {body, head, hair};
  if (what.paint) {
    AppearanceChange blush;
    blush.appearance = 1, blush.base_color = vec4(0.1f, -0.1f, -0.1f, 0);
    for (const char* name : {"happy", "viseme_aa", "viseme_E"})
      blush.displacer = find_displacer(character, name),
      character.appearance_changes.push_back(blush);
  }
  return character;
}

}  // namespace wellspring::test
