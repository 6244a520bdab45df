// SPDX-License-Identifier: Apache-2.0
// Checks and reads the animations of a glTF file.
#pragma once
#include <string>
#include <vector>

#include "base/vec.h"
#include "gltf/file.h"

namespace wellspring::gltf {

// Holds a node of a glTF file's tree (glTF 2.0 section 3.5) as it stands at one moment.

struct Node {
  int parent = -1;
  dvec3 translation{0}, scale{1};
  glm::dquat rotation{1, 0, 0, 0};
  bool has_matrix = false;
  dmat4 matrix{1};
  dmat4 global{1};              // parent.global * local
  std::vector<double> weights;  // morph weights of the node's mesh
  bool shown = false;           // the node is part of the scene that is shown
};

// Returns whether a node's global transform turns the winding round, so that clockwise triangles
// face the viewer (section 3.7.4). It decides for skinned meshes, too, although the node does not
// move them.
inline bool is_mirrored(const dmat4& global) { return glm::determinant(glm::dmat3(global)) < 0; }

// Evaluates keyframes as a glTF file has them (glTF 2.0 section 3.11): STEP, LINEAR (spherical for
// rotations) and CUBICSPLINE, appendix C.

enum class Path { none, translation, rotation, scale, weights };
enum class Curve { step, linear, cubic };

// A track is a channel with its data: `width` numbers a key, three times as many for cubic curves
// (in-tangent, value, out-tangent). Times do not decrease; all numbers are finite.
struct Track {
  Path path = Path::none;
  Curve curve = Curve::linear;
  size_t node = 0;
  size_t width = 0;
  std::vector<float> times, values;
};

struct Clip {
  std::string name;
  std::vector<Track> tracks;
};

double length_of(const Clip& clip);  // seconds until its last key
// Sets what the tracks move to its values at `time`; every track has a key. Before its first and
// after its last key a track holds still. place_nodes() (gltf/animation.h) does the rest.
void move_nodes(const Clip& clip, double time, std::vector<Node>& nodes);

// Returns every animation of the file with its data; checked as animate() does.
std::vector<Clip> read_clips(File& file, const std::vector<Node>& nodes);

// Checks every animation's layout and the first one's data; then, unless `time` is 0, moves `nodes`
// to where the first animation has them.
void animate(File& file, double time, std::vector<Node>& nodes);

// Places every node at one moment: the node tree (glTF 2.0 section 3.5), animations (3.11, appendix
// C) and morph weights, in double precision.

// Returns all nodes of the file at `time` of its first animation; at 0 the rest pose. Throws
// LoadError for nodes with two parents, cycles, and animations that cannot be read.
std::vector<Node> make_pose(File& file, double time);

// Returns the order of all nodes that hang together without a cycle, each after its parent.
std::vector<uint32_t> parents_first(const std::vector<Node>& nodes);
// Finds Node::global of all, in that order, after any have been moved.
void place_nodes(const std::vector<uint32_t>& order, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
