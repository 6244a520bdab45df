// SPDX-License-Identifier: Apache-2.0
// What a VRM file adds to glTF: which node is which bone, whole expressions, how eyes turn, who may
// use it. Versions 0.x (extension "VRM") and 1.0 ("VRMC_vrm"), and animations ("VRMC_vrm_animation").
// What is malformed is refused; what is not there stays empty.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "avatar/character.h"
#include "gltf/file.h"

namespace wellspring {

struct VrmBind {
  int node = -1, mesh = -1;  // one of them names whose morph targets are meant
  size_t target = 0;
  float weight = 1;
};

struct VrmExpression {
  std::string name;  // VRM 1.0's: "aa", "happy", "blinkLeft", or the author's own
  bool preset = false;
  std::vector<VrmBind> binds;
};

struct Vrm {
  int version = -1;                   // 0, 1; -1: no VRM file
  bool animation = false;             // VRMC_vrm_animation
  std::map<size_t, std::string> joints;  // node -> H-Anim joint
  std::vector<VrmExpression> expressions;
  std::map<std::string, size_t> expression_nodes;  // of an animation: whose x is its weight
  EyeGain eye_gain;
  std::map<size_t, bool> matt;  // materials of MToon
  std::vector<std::pair<std::string, std::string>> metadata;
};

// The extensions this and gltf_figure.cpp understand, for load_gltf().
const std::set<std::string>& vrm_extensions();

// Adds to file.warnings what is not done: springs, constraints. Throws LoadError.
Vrm read_vrm(gltf::File& file);

}  // namespace wellspring
