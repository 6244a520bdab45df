// SPDX-License-Identifier: Apache-2.0
// Holds the working state of reading an HAnimHumanoid: x3d_humanoid.cpp walks the skeleton,
// x3d_skin.cpp binds the surfaces, x3d_motion.h reads its motions.
#pragma once
#include <map>
#include <unordered_set>

#include "avatar/figure/character.h"
#include "avatar/load/x3d_mesh.h"

namespace wellspring::avatar {

inline constexpr int max_joints = 4096;
inline constexpr size_t max_vertices = 3'000'000;

// This is the working state of one reading.
struct HumanoidReader {
  explicit HumanoidReader(X3dFile& from) : file(from) { character.first_weight = {0}; }
  X3dFile& file;
  Character character;
  mat4 root{1};  // humanoid's own coordinates to humanoid space
  std::vector<mat4>
      rest;  // per joint: humanoid's own coordinates to humanoid space, scales of joints included
  std::vector<int> joint_node;  // per joint: its node
  std::unordered_set<int> seen_joints;
  std::map<std::tuple<int, int, bool>, int>
      appearances;  // (appearance, colours: 0 none, 1 some, 2 with alpha; solid) -> look
  int visits = 0, depth = 0;
  size_t bytes_read = 0;  // bytes of geometry

  // Says where a Coordinate's points went, for displacers.
  struct Placed {
    int coordinate = -1;
    uint32_t first_vertex = 0;
    std::vector<uint32_t> point_of;
    size_t point_count = 0;
    mat4 matrix{1};
  };
  std::vector<Placed> placed;  // places in the segment being read, or in the skin

  struct Context {
    mat4 matrix{1};
    int joint = -1;
    int segment_node = -1;
  };
  void read_skeleton(int humanoid);
  void walk(int node, const Context& context);
  void read_joint(int node, Context context);
  void read_segment(int node, Context context);
  void walk_children(int node, const Context& context);

  void read_skin(int humanoid);
  // Adds a Shape. With `skin`, vertex v follows skin[point_of[v]]; else all follow `joint`.
  void add_shape(int shape, const mat4& matrix, int joint, const struct SkinPoints* skin);
  void add_displacers(int node, const mat4& direction, int coordinate);
};

// Holds weights of the skinCoord's points.
struct SkinPoints {
  int coordinate = -1;
  size_t count = 0;
  std::vector<uint32_t> first;  // count + 1
  std::vector<JointWeight> weights;
};

}  // namespace wellspring::avatar
