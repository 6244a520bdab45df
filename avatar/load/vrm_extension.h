// SPDX-License-Identifier: Apache-2.0
// Reads what a VRM file adds to glTF: which node is which bone, whole expressions, how eyes turn,
// who may use it. It reads versions 0.x (extension "VRM") and 1.0 ("VRMC_vrm"), and animations
// ("VRMC_vrm_animation"). Malformed parts are refused; absent ones stay empty.
#pragma once
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "avatar/figure/character.h"
#include "gltf/file.h"

namespace wellspring::avatar {

struct VrmBind {
  int node = -1, mesh = -1;  // one of them has the morph targets
  size_t target = 0;
  float weight = 1;
};

struct VrmColorBind {
  size_t material = 0;
  bool emission = false;  // else the base colour
  vec4 target{1};         // linear, instead of the material's factor
};

struct VrmPictureBind {
  size_t material = 0;
  std::array<bool, 2> axis{true, true};  // u, v
  vec2 scale{1}, offset{0};              // replace the picture's, as KHR_texture_transform has them
};

struct VrmExpression {
  std::string name;  // VRM 1.0's: "aa", "happy", "blinkLeft", or the author's own
  bool preset = false, binary = false;
  std::array<ExpressionOverride, expression_groups> overrides{};
  std::vector<VrmBind> binds;
  std::vector<VrmColorBind> colors;
  std::vector<VrmPictureBind> pictures;
};

// This is a joint of hair or cloth that swings, one of a row, as its author tuned it (SpringBone in
// character.h).
struct VrmSpringJoint {
  size_t node = 0;
  int tail_node = -1;  // node at its end; -1: the end lies `tail` away
  vec3 tail{0};        // in the node's own frame
  float stiffness = 1, gravity_power = 0, drag = 0.5f, hit_radius = 0;
  vec3 gravity_direction{0, -1, 0};
  int center = -1;                // node in whose frame its inertia counts
  std::vector<size_t> colliders;  // indices into Vrm::colliders
};

struct VrmCollider {
  size_t node = 0;
  vec3 offset{0}, tail{0};  // in the node's own frame; a sphere's two are the same
  vec3 normal{0};           // normal of a plane, else zero
  float radius = 0;
  bool inside = false;  // keeps what it meets inside
};

// This is a node that turns as another does, with axes of its own (JointConstraint in character.h).
struct VrmConstraint {
  size_t node = 0, source = 0;
  JointConstraint::Kind kind = JointConstraint::Kind::rotation;
  vec3 axis{0};
  float weight = 1;
};

struct Vrm {
  int version = -1;                      // 0, 1; -1: no VRM file
  bool animation = false;                // VRMC_vrm_animation
  std::map<size_t, std::string> joints;  // node -> H-Anim joint
  std::vector<VrmExpression> expressions;
  std::map<std::string, size_t> expression_nodes;  // an animation's nodes, whose x is a weight
  EyeRanges eye_ranges;
  std::set<size_t> lambertian;                   // materials that are drawn as cartoons
  std::set<size_t> hidden_nodes, hidden_meshes;  // seen only by whoever is the figure itself
  std::vector<VrmConstraint> constraints;        // no node twice
  std::vector<VrmSpringJoint> springs;           // no node twice
  std::vector<VrmCollider> colliders;
  std::vector<std::pair<std::string, std::string>> metadata;
};

// Rewrites materials of MToon and of version 0's unlit shaders in glTF's terms: colours, pictures
// and where these lie, alpha, sides, glow. Version 0 keeps them in lists of its own, which count.
// To be called on a file just loaded, before anybody reads its materials. Warns of parts that are
// not shown, by name. Returns the materials that are drawn as cartoons. Throws LoadError.
std::set<size_t> rewrite_vrm_materials(gltf::File& file);

// Returns the extensions this and gltf_figure.cpp understand, for load_gltf().
const std::set<std::string>& vrm_extensions();

// Reads it all. Adds to file.warnings what is not done. Throws LoadError.
Vrm read_vrm(gltf::File& file);
// Read parts of it: expressions of either version (vrm_expression.cpp; `object` is the version's
// extension), springs (vrm_motion.cpp), constraints (vrm_motion.cpp).
void read_vrm_expressions(gltf::File& file, const gltf::json& object, Vrm& vrm);
void read_vrm_springs(gltf::File& file, Vrm& vrm);
void read_vrm_constraints(gltf::File& file, Vrm& vrm);

}  // namespace wellspring::avatar
