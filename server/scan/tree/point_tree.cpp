// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/point_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <zlib.h>

#include "base/load_error.h"
#include "scan/tree/tree_format.h"

namespace wellspring::scan {
namespace {

uint32_t sum_of(const std::byte* from, size_t count) {
  return uint32_t(crc32_z(0, reinterpret_cast<const Bytef*>(from), count));
}

// Checks a file that somebody else may have made.
class TreeReader {
 public:
  TreeReader(PointTree& tree, const DataFile& file) : tree_(tree), size_(file.size()) {
    if (size_ < sizeof head_) fail(0, "is too short for a tree of points");
    file.read_at(0, &head_, sizeof head_);
    check_head();
    tree_.bytes = file.map();
    const uint64_t rest = head_.end_at - head_.table_at;
    if (sum_of(tree_.bytes.get() + head_.table_at, size_t(rest)) != head_.table_sum)
      fail(head_.table_at, "the table of nodes is damaged");
    read_nodes();
    read_stations();
  }

 private:
  [[noreturn]] void fail(uint64_t at, const std::string& what) const {
    throw LoadError(tree_.file, fmt::format("byte {}", at), what);
  }
  [[noreturn]] void fail_node(size_t number, const std::string& what) const {
    fail(head_.table_at + number * sizeof(NodeRecord), fmt::format("node {} {}", number, what));
  }

  void check_head() {
    if (!std::equal(tree_magic.begin(), tree_magic.begin() + tree_magic_letters,
                    head_.magic.begin()))
      fail(0, "is no tree of points");
    if (head_.magic != tree_magic)
      fail(tree_magic_letters, "is a tree of points of another version: import its files again");
    if (sum_of(reinterpret_cast<const std::byte*>(&head_), offsetof(TreeHead, head_sum)) !=
        head_.head_sum)
      fail(0, "the head is damaged");
    if (head_.end_at != size_)
      fail(offsetof(TreeHead, end_at),
           fmt::format("holds {} bytes, its head says {}", size_, head_.end_at));
    if (head_.nodes == 0 || head_.points == 0) fail(offsetof(TreeHead, nodes), "has no node");
    if (head_.table_at < sizeof head_ || head_.table_at > size_ ||
        (size_ - head_.table_at) / sizeof(NodeRecord) < head_.nodes ||
        head_.stations_at != head_.table_at + uint64_t(head_.nodes) * sizeof(NodeRecord))
      fail(offsetof(TreeHead, table_at), "the table of nodes lies outside");
    for (int i = 0; i < 3; i++) {
      if (!std::isfinite(head_.origin[i]) || !std::isfinite(head_.corner[i]))
        fail(offsetof(TreeHead, origin), "has an origin that is not finite");
      tree_.origin[i] = head_.origin[i];
    }
    for (int i = 0; i < 9; i++) tree_.frame[i / 3][i % 3] = head_.frame[i];
    const glm::dmat3 off = tree_.frame * glm::transpose(tree_.frame) - glm::dmat3(1);
    bool is_rotation = glm::determinant(tree_.frame) > 0;
    for (int i = 0; i < 9; i++) is_rotation = is_rotation && std::abs(off[i / 3][i % 3]) < 1e-9;
    if (!is_rotation) fail(offsetof(TreeHead, frame), "has axes that are no rotation");
    int exponent = 0;
    if (!(head_.edge > 0) || !std::isfinite(head_.edge) || std::frexp(head_.edge, &exponent) != 0.5)
      fail(offsetof(TreeHead, edge), "the root's edge is no power of two");
    if (!(head_.density > 0) || !std::isfinite(head_.density))
      fail(offsetof(TreeHead, density), "has no sensible density");
    tree_.points = head_.points, tree_.density = head_.density;
    tree_.has_color = head_.fields & tree_color;
    tree_.has_intensity = head_.fields & tree_intensity;
    tree_.has_classes = head_.fields & tree_classes;
  }

  // Children follow level by level, so that none is its own ancestor and none has two parents.
  void read_nodes() {
    const auto* table = reinterpret_cast<const NodeRecord*>(tree_.bytes.get() + head_.table_at);
    tree_.nodes.resize(head_.nodes);
    uint64_t next = 1;
    for (size_t i = 0; i < head_.nodes; i++) {
      const NodeRecord& record = table[i];
      if (record.level > deepest_level) fail_node(i, "lies too deep");
      if (i >= next) fail_node(i, "is nobody's child");
      for (const uint32_t cell : record.cell)
        if (uint64_t(cell) >> record.level != 0) fail_node(i, "lies outside the root");
      if (!std::isfinite(record.spacing) || !(record.spacing > 0) || !(record.opacity >= 0) ||
          !(record.opacity <= 1))
        fail_node(i, "has a spacing or an opacity that makes no sense");
      if (record.child_mask != 0) {
        if (record.first_child != next) fail_node(i, "has children elsewhere than after others'");
        next += uint64_t(std::popcount(record.child_mask));
        if (next > head_.nodes) fail_node(i, "has children beyond the table");
        check_children(table, i);
      } else if (record.beneath != record.count) fail_node(i, "is a leaf of other points");
      tree_.nodes[i] = node_of(record);
    }
    if (table[0].beneath != head_.points) fail_node(0, "has other points than the head says");
    check_places();
  }

  void check_children(const NodeRecord* table, size_t number) const {
    const NodeRecord& record = table[number];
    uint64_t beneath = 0, child = record.first_child;
    for (uint32_t octant = 0; octant < 8; octant++) {
      if (!(record.child_mask >> octant & 1)) continue;
      const NodeRecord& below = table[child];
      beneath += below.beneath;
      bool is_inside = below.level > record.level && below.level <= deepest_level;
      for (int axis = 0; axis < 3 && is_inside; axis++)
        is_inside = uint64_t(below.cell[axis]) >> (below.level - record.level - 1) ==
                    (uint64_t(record.cell[axis]) << 1 | (octant >> axis & 1));
      if (!is_inside) fail_node(child, "lies outside its parent's octant");
      child++;
    }
    if (beneath != record.beneath) fail_node(number, "counts other points than its children");
  }

  TreeNode node_of(const NodeRecord& record) const {
    TreeNode node;
    const double edge = std::ldexp(head_.edge, -int(record.level));
    for (int i = 0; i < 3; i++) node.corner[i] = head_.corner[i] + record.cell[i] * edge;
    node.size = float(edge), node.spacing = record.spacing, node.opacity = record.opacity;
    node.first_child = record.first_child;
    node.children = uint32_t(std::popcount(record.child_mask));
    node.count = record.count, node.level = record.level;
    node.beneath = record.beneath, node.offset = record.offset;
    return node;
  }

  // No two nodes share columns, and none lies in the head or the table.
  void check_places() const {
    std::vector<uint32_t> order(tree_.nodes.size());
    for (size_t i = 0; i < order.size(); i++) order[i] = uint32_t(i);
    std::ranges::sort(order, {}, [&](uint32_t i) { return tree_.nodes[i].offset; });
    uint64_t end = sizeof head_;
    for (const uint32_t i : order) {
      const TreeNode& node = tree_.nodes[i];
      const uint64_t bytes = NodeColumns(node.count, tree_.has_classes).end;
      if (node.count == 0) fail_node(i, "has no point");
      if (node.offset % column_align != 0) fail_node(i, "lies at no multiple of 64 bytes");
      if (node.offset < end) fail_node(i, "overlaps another one, or the head");
      if (node.offset > head_.table_at - column_align ||
          head_.table_at - column_align - node.offset < bytes)
        fail_node(i, "has points beyond the table's begin");
      end = node.offset + bytes;
    }
  }

  void read_stations() {
    uint64_t at = head_.stations_at;
    const auto take = [&](void* to, size_t count) {
      if (head_.end_at - at < count) fail(at, "the stations are cut off");
      std::memcpy(to, tree_.bytes.get() + at, count);
      at += count;
    };
    for (uint32_t i = 0; i < head_.stations; i++) {
      Station station;
      uint32_t letters = 0;
      take(&station.place, sizeof station.place), take(&letters, sizeof letters);
      if (head_.end_at - at < letters) fail(at, "a station's name is cut off");
      station.name.resize(letters);
      take(station.name.data(), letters);
      for (int axis = 0; axis < 3; axis++)
        if (!std::isfinite(station.place[axis])) fail(at, "a station is at no place");
      tree_.stations.push_back(std::move(station));
    }
    if (at != head_.end_at) fail(at, "has more bytes than stations");
  }

  PointTree& tree_;
  const uint64_t size_;
  TreeHead head_;
};

}  // namespace

NodePoints PointTree::points_of(uint32_t number) const {
  const TreeNode& node = nodes[number];
  const NodeColumns columns(node.count, has_classes);
  const std::byte* from = bytes.get() + node.offset;
  NodePoints of;
  of.corner = node.corner, of.size = node.size, of.spacing = node.spacing;
  of.count = node.count;
  of.x = reinterpret_cast<const uint16_t*>(from + columns.x);
  of.y = reinterpret_cast<const uint16_t*>(from + columns.y);
  of.z = reinterpret_cast<const uint16_t*>(from + columns.z);
  of.color = reinterpret_cast<const uint32_t*>(from + columns.color);
  of.normal = reinterpret_cast<const uint16_t*>(from + columns.normal);
  of.own_spacing = reinterpret_cast<const uint8_t*>(from + columns.own_spacing);
  if (has_classes)
    of.classification = reinterpret_cast<const uint8_t*>(from + columns.classification);
  return of;
}

PointTree map_tree(const std::string& name, const DataFile& file) {
  PointTree tree;
  tree.file = name;
  TreeReader(tree, file);
  return tree;
}

PointTree open_tree(const std::string& path) {
  return map_tree(path, DataFile::open_to_read(path));
}

}  // namespace wellspring::scan
