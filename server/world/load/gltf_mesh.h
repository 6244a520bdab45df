// SPDX-License-Identifier: Apache-2.0
// Turns primitives of a glTF file into triangles: topologies, attributes, morph targets, skins
// (glTF 2.0 section 3.7).
#pragma once
#include <vector>

#include "base/vec.h"
#include "gltf/file.h"
#include "world/motion/scene_motion.h"
#include "world/scene.h"

namespace wellspring::world {

// Holds what poses a primitive's vertices: morph weights and, for skinned ones, a matrix per joint.
struct Deformation {
  std::vector<double> weights;
  std::vector<dmat4> joints;  // joint to world; empty: not skinned
  bool mirrored = false;      // the node of a skinned mesh turns its winding round
};

// Holds a mesh and the place of its vertices' zero, so that positions far from zero keep their
// precision.
struct BuiltMesh {
  Mesh mesh;
  dvec3 centre{0};
  std::vector<uint32_t> from;  // vertex i is the file's vertex from[i]
  bool flat = false;           // the file has no normals: the mesh has its faces'
};

// Builds primitive `primitive` of mesh `mesh`. No triangles: points, lines or nothing at all; a
// warning says so. Positions are in the mesh's space, or in world space if skinned. `tangent_uv`:
// the set of texture coordinates of its normal map or anisotropy, so that tangents are made; -1: it
// has neither.
BuiltMesh build_primitive(File& file, size_t mesh, size_t primitive, const Deformation& deformation,
                          int tangent_uv);

// Returns the products of joints and bind matrices of a skin, `global` being every node's
// transform.
std::vector<dmat4> joint_matrices(File& file, size_t skin, const std::vector<dmat4>& global);

// Loads the animations of a glTF file, and the meshes that they move, into a SceneMotion.

class MotionLoad {
 public:
  // `nodes`: at rest. Throws LoadError for animations that cannot be read.
  MotionLoad(File& file, const std::vector<Node>& nodes);

  struct Shown {
    int instance = 0;  // index into Scene::instances
    size_t node = 0, mesh = 0, primitive = 0;
    int skin = -1;  // index of the file's skin; -1: none
    int tangent_uv = -1;
  };
  void note(const Shown& shown);
  // Adds the motion to the scene, if any clip moves anything noted.
  void finish(Scene& scene);

 private:
  Mover make_mover(const Shown& shown);
  File& file_;
  SceneMotion motion_;
  std::vector<Shown> shown_;
};

}  // namespace wellspring::world
