// SPDX-License-Identifier: Apache-2.0
// The file NAME.points: an octree of points, made to be mapped. Numbers are little-endian.
//
// - TreeHead, alone on the first page.
// - The columns of all nodes (NodeColumns says how a node's lie); a node of 64 KiB and more begins
//   on a page. Nodes that are near lie near each other; those above all chunks are the last.
// - The table of nodes: NodeRecord each, level by level from the root, children side by side.
// - Stations, each three doubles, a uint32 and a name of so many bytes.
//
// The root's cube has an edge of a power of two in metres. A node of level n is a cube of
// edge / 2^n at a whole number of its edges. A child lies in one octant of its parent and may be
// smaller than that: an inner node has two children or more, whatever lies between is left out.
#pragma once
#include <array>
#include <bit>
#include <cstdint>

#include "base/layers.h"

namespace wellspring::scan {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::array<char, 8> tree_magic{'W', 'S', 'p', 'o', 'i', 'n', 't', '2'};
// Files of versions before begin with these letters, and another number.
inline constexpr size_t tree_magic_letters = 7;
inline constexpr uint64_t tree_page = 4096;
inline constexpr uint64_t column_align = 64;     // bytes
inline constexpr uint64_t page_from = 64 << 10;  // bytes of a node that begins on a page
inline constexpr int position_bits = 48;         // a place along the root's edge has so many
inline constexpr int deepest_level = 32;         // cells of nodes are 32-bit numbers
inline constexpr int voxel_bits = 7, voxel_side = 1 << voxel_bits;  // an inner node's means
inline constexpr double largest_leaf = 32;  // metres: a step of a leaf is half a millimetre

enum TreeFieldBits : uint32_t { tree_color = 1, tree_intensity = 2, tree_classes = 4 };

struct TreeHead {
  std::array<char, 8> magic;
  double origin[3];  // metres in the frame of the sources, turned so that +Y is up
  double corner[3];  // the root's cube's lowest, from there
  double edge;       // the root's cube's, metres
  double density;    // points of a square metre of surface, typically
  double frame[9];   // columns of a rotation from the sources' axes to the tree's
  uint64_t points;   // leaves hold so many
  uint64_t table_at, stations_at, end_at;  // bytes; the file is as long as `end_at`
  uint32_t nodes, stations;
  uint32_t fields;     // TreeFieldBits
  uint32_t table_sum;  // CRC-32 of what lies from table_at to end_at
  uint32_t head_sum;   // CRC-32 of all above
  uint32_t none;
};
static_assert(sizeof(TreeHead) == 8 + 8 * 21 + 24);

struct NodeRecord {
  uint32_t cell[3];  // in edges of this level's cubes, from the root's corner
  uint8_t level;
  uint8_t child_mask;  // octants that have a child: bit x + 2 y + 4 z; 0: a leaf
  uint16_t none;
  uint64_t offset;       // bytes from the file's begin to its columns
  uint64_t beneath;      // points of all leaves in it
  uint32_t count;        // points of its columns
  uint32_t first_child;  // its number in the table
  float spacing;         // metres
  float opacity;         // share of lines through its cube that its points stop (opacity.h)
};
static_assert(sizeof(NodeRecord) == 48);

inline uint64_t round_up(uint64_t n, uint64_t to) { return (n + to - 1) / to * to; }

// Says where a node's columns lie, in bytes from its offset.
struct NodeColumns {
  uint64_t x = 0, y = 0, z = 0, color = 0, normal = 0, own_spacing = 0, classification = 0, end = 0;
  NodeColumns(uint64_t count, bool has_classes) {
    const auto place = [&](uint64_t bytes) {
      const uint64_t at = end;
      end = round_up(end + bytes * count, column_align);
      return at;
    };
    x = place(2), y = place(2), z = place(2), color = place(4), normal = place(2);
    own_spacing = place(1);
    if (has_classes) classification = place(1);
  }
};
// Returns where a node's columns may begin if bytes before `from` are taken.
inline uint64_t place_node(uint64_t from, const NodeColumns& columns) {
  return round_up(from, columns.end >= page_from ? tree_page : column_align);
}

}  // namespace wellspring::scan
