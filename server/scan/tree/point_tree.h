// SPDX-License-Identifier: Apache-2.0
// An octree of points (tree_format.h) as it is drawn: its nodes in memory, their points mapped.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scan/points.h"
#include "scan/tree/data_file.h"
#include "scan/tree/node_points.h"

namespace wellspring::scan {

struct TreeNode {
  dvec3 corner{0};  // metres, relative to PointTree::origin; the cube's lowest
  float size = 0;   // the cube's edge
  float spacing = 0;
  float opacity = 0;  // share of lines through the cube that its points stop (opacity.h)
  uint32_t first_child = 0, children = 0;  // they lie side by side; 0: a leaf
  uint32_t count = 0;                      // points that stand for the node
  uint8_t level = 0;                       // the cube's edge is the root's halved so many times
  uint64_t beneath = 0;                    // points of all leaves in it
  uint64_t offset = 0;                     // bytes to its columns

  bool is_leaf() const { return children == 0; }
};

// Nodes are numbered level by level, the root is 0. Copies share what is mapped. A file that others
// shorten while it is mapped ends the process with a signal: write_tree() never does.
struct PointTree {
  std::string file;
  glm::dmat3 frame{1};  // turns the sources' axes to the tree's, of which +Y is up
  dvec3 origin{0};      // metres, in the frame of the sources once it is turned
  uint64_t points = 0;
  double density = 0;  // points of a square metre of surface, typically
  bool has_color = false, has_intensity = false, has_classes = false;
  std::vector<Station> stations;  // places are relative to the origin
  std::vector<TreeNode> nodes;
  std::shared_ptr<const std::byte> bytes;

  // Borrows from the mapped file; any thread.
  NodePoints points_of(uint32_t node) const;
};

// Maps a file. Reads its head and its table, no point. Throws LoadError that names file and place.
PointTree open_tree(const std::string& path);

// Maps a file that is open already, in memory perhaps; errors call it by this name.
PointTree map_tree(const std::string& name, const DataFile& file);

}  // namespace wellspring::scan
