// SPDX-License-Identifier: Apache-2.0
// Finds the H-Anim joints of other skeletons' bones (VRM, Mixamo, Rigify, 3ds Max biped, Unreal,
// Daz, motion capture): by what their names say, and if names say nothing, by the shape of the
// skeleton. A bone that means nothing to H-Anim gets no name and stays what it is.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace wellspring::avatar {

struct Bone {
  std::string name;
  int parent = -1;  // smaller than the bone's own index
  vec3 place{0};    // at rest, +Y up
};

struct BoneNames {
  std::vector<std::string> joints;  // one a bone: its H-Anim name, empty for none; each used once
  bool by_shape = false;            // names alone did not suffice
};

BoneNames name_bones(const std::vector<Bone>& bones);

// Returns the H-Anim joint of a VRM humanoid bone ("leftUpperArm"); empty for none. Version 0
// counts the thumb's bones differently.
std::string vrm_bone_joint(std::string_view bone, int version);

// Returns a turn by right angles after which a skeleton of these joints stands upright (+Y) and
// looks along +Z.
quat upright_turn(const std::vector<std::string>& joints, const std::vector<vec3>& places);

// Names what a bone's name says by itself.
enum class BonePart {
  none,
  root,
  hips,
  spine,
  neck,
  head,
  eye,
  jaw,
  lid,
  brow,
  collar,
  shoulder,
  upper_arm,
  arm,
  forearm,
  wrist,
  hand,
  hip,
  thigh,
  leg,
  shin,
  ankle,
  foot,
  toe,
  thumb,
  index,
  middle,
  ring,
  little,
  finger,
  helper  // twists, targets, ends, cloth: never a joint of the body
};
struct BoneWord {
  BonePart part = BonePart::none;
  int side = -1;    // 0 left, 1 right
  int number = -1;  // number behind the name; finger bones: 0 metacarpal, 1, 2, 3 from the palm
};
BoneWord read_bone_name(std::string_view name);
std::string_view bone_words_json();  // avatar/library/bone_words.json

// Finds H-Anim names by position alone: legs, trunk, arms and head of an upright figure. All are
// empty if the skeleton is no person's.
std::vector<std::string> name_bones_by_shape(const std::vector<Bone>& bones);

// Return `count` names from vl5 upwards, or from vc4 upwards below the skull; fewer if there are
// fewer.
std::vector<std::string> spine_names(size_t count);
std::vector<std::string> neck_names(size_t count);

}  // namespace wellspring::avatar
