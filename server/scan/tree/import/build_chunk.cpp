// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/build_chunk.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/rng.h"
#include "scan/tree/octahedral.h"

namespace wellspring::scan {
namespace {

void append_columns(std::vector<uint8_t>& bytes, NodeRecord& record, const NodeColumnData& data,
                    bool has_classes) {
  const NodeColumns columns(data.size(), has_classes);
  record.offset = place_node(bytes.size(), columns);
  bytes.resize(record.offset + columns.end);
  uint8_t* to = bytes.data() + record.offset;
  const auto put = [to](uint64_t at, const auto& column) {
    std::memcpy(to + at, column.data(), column.size() * sizeof(column[0]));
  };
  put(columns.x, data.x), put(columns.y, data.y), put(columns.z, data.z);
  put(columns.color, data.color), put(columns.normal, data.normal);
  put(columns.own_spacing, data.own_spacing);
  if (has_classes) put(columns.classification, data.classification);
}

// Splits the points of a chunk into octants until nodes are leaves.
class ChunkBuilder {
 public:
  ChunkBuilder(const BuildSettings& settings, BuiltPart& part)
      : settings_(settings), part_(part), maker_(settings) {}

  // Builds the node of points that lie in a cube of this level, or one deeper that holds them all.
  // Returns its number; `sums` are its own unless it is a leaf.
  uint32_t build(ChunkPoint* points, ChunkPoint* spare, size_t count, uint32_t level,
                 std::vector<VoxelSum>& sums) {
    NodeCube cube = smallest_cube(points, count, level);
    const bool is_small = edge_of(settings_.cube, cube.level) <= largest_leaf;
    if ((count <= settings_.leaf_points && is_small) || cube.level == deepest_level) {
      maker_.add_leaf(part_, cube, points, count);
      return uint32_t(part_.nodes.size() - 1);
    }
    const std::array<size_t, 9> starts = split(points, spare, count, cube.level);
    BuiltNode node;
    node.record.level = uint8_t(cube.level);
    for (int axis = 0; axis < 3; axis++) node.record.cell[axis] = cube.cell[axis];
    std::vector<VoxelSum> below;
    for (uint32_t octant = 0; octant < 8; octant++) {
      const size_t from = starts[octant], size = starts[octant + 1] - from;
      if (size == 0) continue;
      const uint32_t child = build(spare + from, points + from, size, cube.level + 1, below);
      node.children[octant] = child, node.record.child_mask |= uint8_t(1u << octant);
      const BuiltNode& built = part_.nodes[child];
      node.record.beneath += built.record.beneath;
      if (built.record.child_mask == 0)
        maker_.gatherer().add_points(sums, cube, built.cube(), maker_.columns());
      else maker_.gatherer().add_sums(sums, cube, built.cube(), below);
      below.clear();
    }
    maker_.add_inner(part_, node, sums);
    return uint32_t(part_.nodes.size() - 1);
  }

 private:
  static NodeCube smallest_cube(const ChunkPoint* points, size_t count, uint32_t level) {
    uint64_t differs = 0;
    for (size_t i = 1; i < count; i++)
      for (int axis = 0; axis < 3; axis++) differs |= points[i].place(axis) ^ points[0].place(axis);
    const int common = std::countl_zero(differs) - (64 - position_bits);
    NodeCube cube;
    cube.level = std::max(level, uint32_t(std::min(common, deepest_level)));
    for (int axis = 0; axis < 3; axis++)
      cube.cell[axis] =
          cube.level == 0 ? 0 : uint32_t(points[0].place(axis) >> (position_bits - cube.level));
    return cube;
  }

  // Moves points to `to`, sorted by octants and in their order within.
  static std::array<size_t, 9> split(const ChunkPoint* points, ChunkPoint* to, size_t count,
                                     uint32_t level) {
    const int shift = position_bits - 1 - int(level);
    const auto octant = [shift](const ChunkPoint& point) {
      return size_t(point.place(0) >> shift & 1) | size_t(point.place(1) >> shift & 1) << 1 |
             size_t(point.place(2) >> shift & 1) << 2;
    };
    std::array<size_t, 9> starts{};
    for (size_t i = 0; i < count; i++) starts[octant(points[i]) + 1]++;
    for (size_t i = 1; i < 9; i++) starts[i] += starts[i - 1];
    std::array<size_t, 9> next = starts;
    for (size_t i = 0; i < count; i++) to[next[octant(points[i])]++] = points[i];
    return starts;
  }

  const BuildSettings& settings_;
  BuiltPart& part_;
  NodeMaker maker_;
};

}  // namespace

void NodeMaker::add(BuiltPart& part, BuiltNode node, float spacing) {
  NodeRecord& record = node.record;
  record.count = uint32_t(columns_.size());
  record.spacing = spacing / 65536 * float(edge_of(settings_.cube, record.level));
  spheres_.resize(columns_.size());
  for (size_t i = 0; i < columns_.size(); i++)
    spheres_[i] = {(vec3(columns_.x[i], columns_.y[i], columns_.z[i]) + 0.5f) / 65536.0f,
                   spacing / 65536};
  const uint64_t seed =
      mix64(record.level ^ mix64(record.cell[0] ^ mix64(record.cell[1] ^ mix64(record.cell[2]))));
  if (spacing > 0)
    record.opacity =
        sample_opacity({vec3(0), vec3(1)}, spheres_, opacity_lines, seed, opacity_least);
  append_columns(part.bytes, record, columns_, settings_.has_classes);
  part.nodes.push_back(node);
}

void NodeMaker::set_own_spacing(size_t point, float distance, float spacing) {
  const float share = distance > 0 && spacing > 0 ? distance / spacing : 1;
  columns_.own_spacing[point] = uint8_t(std::min(share * own_spacing_steps + 0.5f, 255.0f));
}

// Turns a normal to the station from which the point was seen, or else up: both sides of a point
// are drawn, so the sign matters to those who read it alone.
vec3 NodeMaker::outward(vec3 normal, const ChunkPoint& point, vec3 place) const {
  const bool is_known = point.station < settings_.stations.size();
  const vec3 to = is_known ? settings_.stations[point.station] - place : vec3(0, 1, 0);
  return glm::dot(normal, to) < 0 ? -normal : normal;
}

void NodeMaker::add_leaf(BuiltPart& part, const NodeCube& cube, const ChunkPoint* points,
                         size_t count) {
  const int shift = position_bits - 16 - int(cube.level);
  given_.resize(count);
  bool have_all = true;
  for (size_t i = 0; i < count; i++) {
    given_.x[i] = uint16_t(points[i].place(0) >> shift);
    given_.y[i] = uint16_t(points[i].place(1) >> shift);
    given_.z[i] = uint16_t(points[i].place(2) >> shift);
    have_all = have_all && points[i].normal != no_normal;
  }
  neighbours_.sort({given_.x, given_.y, given_.z});
  const float spacing = neighbours_.look(own_, have_all ? nullptr : &normals_);
  const double edge = edge_of(settings_.cube, cube.level);
  const vec3 corner = vec3(dvec3(cube.cell) * edge);
  columns_.resize(count);
  for (size_t i = 0; i < count; i++) {
    const uint32_t from = neighbours_.order()[i];
    const ChunkPoint& point = points[from];
    columns_.x[i] = given_.x[from], columns_.y[i] = given_.y[from], columns_.z[i] = given_.z[from];
    columns_.color[i] = point.color, columns_.classification[i] = point.classification;
    columns_.normal[i] = point.normal;
    set_own_spacing(i, own_[i], spacing);
    if (point.normal != no_normal || have_all) continue;
    const vec3 place =
        corner + vec3(columns_.x[i], columns_.y[i], columns_.z[i]) * float(edge / 65536);
    columns_.normal[i] = encode_octahedral(outward(normals_[i], point, place));
  }
  BuiltNode node;
  node.record.level = uint8_t(cube.level), node.record.beneath = count;
  for (int axis = 0; axis < 3; axis++) node.record.cell[axis] = cube.cell[axis];
  add(part, node, spacing);
}

void NodeMaker::add_inner(BuiltPart& part, BuiltNode node, std::span<const VoxelSum> sums) {
  make_means(columns_, sums);
  neighbours_.sort({columns_.x, columns_.y, columns_.z});
  const float spacing = neighbours_.look(own_, nullptr);
  for (size_t i = 0; i < own_.size(); i++)
    set_own_spacing(neighbours_.order()[i], own_[i], spacing);
  add(part, node, spacing);
}

BuiltPart build_chunk(const BuildSettings& settings, const Chunk& chunk,
                      std::vector<ChunkPoint>& points, std::vector<ChunkPoint>& spare) {
  BuiltPart part;
  part.bytes.reserve(points.size() * 19);
  ChunkBuilder(settings, part)
      .build(points.data(), spare.data(), points.size(), chunk.level, part.sums);
  return part;
}

NodeCube common_cube(const NodeCube& a, const NodeCube& b) {
  NodeCube cube{std::min(a.level, b.level), {0, 0, 0}};
  const glm::uvec3 of_a = a.cell >> (a.level - cube.level), of_b = b.cell >> (b.level - cube.level);
  const glm::uvec3 differs = of_a ^ of_b;
  const uint32_t bits = uint32_t(32 - std::countl_zero(differs.x | differs.y | differs.z));
  cube.level -= bits;
  cube.cell = bits < 32 ? of_a >> bits : glm::uvec3(0);
  return cube;
}

}  // namespace wellspring::scan
