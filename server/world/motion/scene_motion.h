// SPDX-License-Identifier: Apache-2.0
// Describes what the animations of one glTF file can move: nodes, morph targets and skins (glTF 2.0
// sections 3.7 and 3.11). A SceneMotion is immutable once read; a moment of it is a ScenePose.
// Vertices that a clip moves are found on the CPU, as the World's moving meshes want them.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gltf/animation.h"
#include "world/scene.h"

namespace wellspring::world {

struct MorphTarget {
  std::vector<vec3> positions, normals;  // differences; empty, or as long as the mesh's
};

struct MoverJoint {
  uint32_t node = 0;
  dmat4 bind{1};  // inverse bind matrix
};

struct MoverInfluence {
  uint32_t joint = 0;
  float weight = 0;
};

// A mover is an instance of the scene that hangs on a node which a clip moves, or is bent by a
// clip.
struct Mover {
  uint32_t node = 0;
  Mesh mesh;          // neither moved nor bent: in the space of its node, relative to `centre`
  dvec3 centre{0};    // zero of the positions, so that far ones keep their precision
  bool flat = false;  // the file has no normals: the mesh has its faces'
  std::vector<MorphTarget> targets;
  std::vector<MoverJoint> joints;         // empty: no skin
  std::vector<uint32_t> first_influence;  // for each vertex, and the end
  std::vector<MoverInfluence> influences;
};

struct SceneMotion {
  std::string file;               // file's name without its folder
  std::vector<gltf::Node> nodes;  // at rest
  std::vector<uint32_t> order;    // order of the nodes, parents first
  std::vector<gltf::Clip> clips;  // clips without a name are called by their number
  std::vector<Mover> movers;
};

// Returns whether the clip moves the mover's node or one above it, a joint of its skin, or its
// morph targets.
bool moves(const SceneMotion& motion, const gltf::Clip& clip, const Mover& mover);

// Holds where all nodes are at a moment. `times`: for each clip, seconds; below 0: the clip is not
// used.
struct ScenePose {
  std::vector<gltf::Node> nodes;
};
void pose_motion(const SceneMotion& motion, const std::vector<double>& times, ScenePose& pose);

// Finds the mover's vertices in that pose. `to_scene` takes the file's coordinates to those
// relative to the scene's origin.
void pose_mover(const ScenePose& pose, const Mover& mover, const dmat4& to_scene,
                std::vector<vec3>& positions, std::vector<vec3>& normals);

// Halves edges longer than `longest` metres (`scale`: metres per unit of the mesh), so that light
// that is kept at vertices is fine enough; to at most `most_triangles`. A mover with a skin stays
// as it is.
void subdivide(Mover& mover, double scale, double longest, size_t most_triangles);

}  // namespace wellspring::world
