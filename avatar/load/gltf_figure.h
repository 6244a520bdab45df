// SPDX-License-Identifier: Apache-2.0
// Loads skins of glTF files and VRM models as H-Anim figures. The skeleton (gltf_figure_joints.cpp)
// is turned to face +Z and put at rest in its bind pose with all joint axes along humanoid space,
// so that gestures need not know how the file's bones lie; the surfaces (gltf_figure_skin.cpp) come
// to rest with it; morph targets become displacers and VRM's expressions sums of them; every
// animation becomes a Motion (gltf_motion.cpp).
#pragma once
#include "avatar/figure/character.h"
#include "avatar/load/vrm_extension.h"
#include "gltf/animation.h"

namespace wellspring::avatar {

// Computes small geometry of node trees.

std::vector<size_t> gltf_parents_first(const std::vector<gltf::Node>& nodes);
// Returns the turn in a matrix that may also scale; a mirrored one loses its mirroring.
glm::dquat gltf_rotation(const dmat4& matrix);
// Returns the one of the 24 turns of a cube that is most like `turn`.
glm::dquat nearest_right_turn(glm::dquat turn);

inline constexpr size_t most_displacements = 20'000'000;  // vertices moved in a figure

// This is the working state of one reading.
struct GltfFigure {
  gltf::File file;
  std::vector<gltf::Node> nodes;  // nodes with their transforms at rest
  Vrm vrm;
  Character character;
  std::vector<int> joint_of;       // per node; -1: none
  std::vector<int> nearest_joint;  // per node: its own joint or that of the nearest node above
  std::vector<size_t> node_of;     // per joint
  dmat4 to_humanoid{1};            // the file's world to humanoid space
  std::vector<dmat4> rest;         // per node: to the file's world, in the figure's rest pose
  std::map<std::pair<size_t, size_t>, Displacer> moves;  // moves of morph target (node, target)
};

void read_gltf_joints(GltfFigure& figure);
void read_gltf_surfaces(GltfFigure& figure);
void read_gltf_expressions(GltfFigure& figure);
void read_gltf_constraints(GltfFigure& figure);
void read_gltf_springs(GltfFigure& figure);
void read_gltf_motions(GltfFigure& figure);

// Loads a whole figure, one without surface if the file only moves. Throws LoadError; refuses files
// without a skeleton.
Character character_from_gltf(const std::string& path);

}  // namespace wellspring::avatar
