// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/import/index_parts.h"

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <zlib.h>

#include "base/load_error.h"

namespace wellspring::scan {

struct PartLog::Entry {
  uint64_t end = 0;  // bytes of the tree's file, with this part
  uint32_t nodes = 0, sums = 0;
  uint32_t sum = 0;  // CRC-32 of nodes and sums
  uint32_t part = 0;
};

namespace {

constexpr uint64_t worker_bytes = uint64_t(12) << 20;  // tables of one core

template <class T>
uint32_t add_sum(uint32_t sum, const std::vector<T>& values) {
  return uint32_t(
      crc32_z(sum, reinterpret_cast<const Bytef*>(values.data()), values.size() * sizeof(T)));
}

// Lets threads put their parts into the file in the order of chunks.
class Turns {
 public:
  explicit Turns(size_t first) : next_(first) {}
  // Calls `put` when all earlier parts are there; never if one of them does not come.
  template <class Put>
  void take(size_t number, const Put& put) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return next_ == number || fails_; });
    if (fails_) return;
    put();
    next_++;
    changed_.notify_all();
  }
  void fail() {
    std::lock_guard lock(mutex_);
    fails_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  size_t next_;
  bool fails_ = false;
};

// Makes the levels above the parts, depth first.
class Merger {
 public:
  Merger(BuiltNodes& built, const BuildSettings& settings, const PartLog& log, const DataFile& tree)
      : built_(built), settings_(settings), log_(log), tree_(tree), maker_(settings) {}

  // Returns the number of the node that holds these parts, and adds its points to those of
  // `parent`, if there is one.
  uint32_t merge(size_t from, size_t to, const NodeCube* parent, std::vector<VoxelSum>& above) {
    std::vector<VoxelSum> sums;
    uint32_t number;
    if (to - from == 1) {
      number = log_.parts()[from].root;
      if (parent) add_part(from, *parent, above);
      return number;
    }
    const NodeCube cube = common_cube(cube_of(from), cube_of(to - 1));
    BuiltNode node;
    node.record.level = uint8_t(cube.level);
    for (int axis = 0; axis < 3; axis++) node.record.cell[axis] = cube.cell[axis];
    for (size_t begin = from, end; begin < to; begin = end) {
      const uint32_t octant = octant_of(cube, cube_of(begin));
      for (end = begin + 1; end < to && octant_of(cube, cube_of(end)) == octant;) end++;
      const uint32_t child = merge(begin, end, &cube, sums);
      node.children[octant] = child, node.record.child_mask |= uint8_t(1u << octant);
      node.record.beneath += built_.nodes[child].record.beneath;
    }
    number = add(node, sums);
    if (parent) maker_.gatherer().add_sums(above, *parent, cube, sums);
    return number;
  }

 private:
  NodeCube cube_of(size_t part) const { return built_.nodes[log_.parts()[part].root].cube(); }

  void add_part(size_t number, const NodeCube& parent, std::vector<VoxelSum>& above) {
    const PartPlace& part = log_.parts()[number];
    const BuiltNode& root = built_.nodes[part.root];
    if (root.record.child_mask != 0) {
      std::vector<VoxelSum> sums;
      log_.read_sums(number, sums);
      maker_.gatherer().add_sums(above, parent, root.cube(), sums);
      return;
    }
    const NodeColumns columns(root.record.count, settings_.has_classes);
    const auto take = [&](uint64_t at, auto& column) {
      tree_.read_at(root.record.offset + at, column.data(), column.size() * sizeof(column[0]));
    };
    leaf_.resize(root.record.count);
    take(columns.x, leaf_.x), take(columns.y, leaf_.y), take(columns.z, leaf_.z);
    take(columns.color, leaf_.color), take(columns.normal, leaf_.normal);
    if (settings_.has_classes) take(columns.classification, leaf_.classification);
    maker_.gatherer().add_points(above, parent, root.cube(), leaf_);
  }

  uint32_t add(const BuiltNode& node, const std::vector<VoxelSum>& sums) {
    BuiltPart part;
    maker_.add_inner(part, node, sums);
    const uint64_t begin = round_up(built_.end, tree_page);
    tree_.write_at(begin, part.bytes.data(), part.bytes.size());
    built_.end = begin + part.bytes.size();
    part.nodes[0].record.offset += begin;
    built_.nodes.push_back(part.nodes[0]);
    return uint32_t(built_.nodes.size() - 1);
  }

  BuiltNodes& built_;
  const BuildSettings& settings_;
  const PartLog& log_;
  const DataFile& tree_;
  NodeMaker maker_;
  NodeColumnData leaf_;
};

}  // namespace

void PartLog::take(BuiltNodes& built, const Entry& entry, std::vector<BuiltNode> nodes,
                   uint64_t at) {
  const auto first = uint32_t(built.nodes.size());
  for (BuiltNode& node : nodes) {
    for (uint32_t octant = 0; octant < 8; octant++)
      if (node.record.child_mask >> octant & 1) node.children[octant] += first;
    built.nodes.push_back(node);
  }
  built.end = entry.end;
  const uint64_t sums_at = at + sizeof entry + nodes.size() * sizeof(BuiltNode);
  parts_.push_back({uint32_t(built.nodes.size() - 1), sums_at, entry.sums});
  end_ = sums_at + entry.sums * sizeof(VoxelSum);
}

void PartLog::resume(BuiltNodes& built) {
  const uint64_t size = file_.size();
  for (;;) {
    Entry entry;
    if (size - end_ < sizeof entry) break;
    file_.read_at(end_, &entry, sizeof entry);
    const uint64_t bytes = entry.nodes * sizeof(BuiltNode) + entry.sums * sizeof(VoxelSum);
    if (entry.nodes == 0 || entry.part != parts_.size() || size - end_ - sizeof entry < bytes)
      break;
    std::vector<BuiltNode> nodes(entry.nodes);
    std::vector<VoxelSum> sums(entry.sums);
    const uint64_t at = end_ + sizeof entry;
    file_.read_at(at, nodes.data(), nodes.size() * sizeof(BuiltNode));
    file_.read_at(at + nodes.size() * sizeof(BuiltNode), sums.data(),
                  sums.size() * sizeof(VoxelSum));
    if (add_sum(add_sum(0, nodes), sums) != entry.sum) break;
    take(built, entry, std::move(nodes), end_);
  }
  file_.cut(end_);
}

void PartLog::add(BuiltNodes& built, const BuiltPart& part, uint64_t begin) {
  std::vector<BuiltNode> nodes = part.nodes;
  for (BuiltNode& node : nodes) node.record.offset += begin;
  Entry entry;
  entry.end = begin + part.bytes.size(), entry.part = uint32_t(parts_.size());
  entry.nodes = uint32_t(nodes.size()), entry.sums = uint32_t(part.sums.size());
  entry.sum = add_sum(add_sum(0, nodes), part.sums);
  const uint64_t at = end_;
  file_.write_at(at, &entry, sizeof entry);
  file_.write_at(at + sizeof entry, nodes.data(), nodes.size() * sizeof(BuiltNode));
  file_.write_at(at + sizeof entry + nodes.size() * sizeof(BuiltNode), part.sums.data(),
                 part.sums.size() * sizeof(VoxelSum));
  take(built, entry, std::move(nodes), at);
}

void PartLog::read_sums(size_t part, std::vector<VoxelSum>& sums) const {
  sums.resize(parts_[part].sums);
  file_.read_at(parts_[part].sums_at, sums.data(), sums.size() * sizeof(VoxelSum));
}

void index_chunks(PartLog& log, BuiltNodes& built, const BuildSettings& settings,
                  const std::vector<Chunk>& chunks, const DataFile& points, const DataFile& tree,
                  uint64_t memory, HeldBytes& held, StageProgress& progress) {
  uint64_t most = 1;
  for (const Chunk& chunk : chunks) most = std::max(most, chunk.count);
  const auto workers =
      int(std::clamp<uint64_t>(memory / (most * built_point_bytes + worker_bytes), 1, 1024));
  const size_t first = log.parts().size();
  for (size_t i = 0; i < first; i++) progress.add(chunks[i].count);
  Turns turns(first);
  run_in_order(chunks.size() - first, workers, [&](size_t i) {
    const size_t number = first + i;
    const Chunk& chunk = chunks[number];
    try {
      Hold hold(held, worker_bytes + 2 * chunk.count * sizeof(ChunkPoint));
      std::vector<ChunkPoint> taken(chunk.count), spare(chunk.count);
      points.read_at(chunk.first * sizeof(ChunkPoint), taken.data(),
                     chunk.count * sizeof(ChunkPoint));
      const BuiltPart part = build_chunk(settings, chunk, taken, spare);
      hold.grow(part.bytes.capacity() + part.sums.capacity() * sizeof(VoxelSum));
      turns.take(number, [&] {
        const uint64_t begin = round_up(built.end, tree_page);
        tree.write_at(begin, part.bytes.data(), part.bytes.size());
        log.add(built, part, begin);
      });
      progress.add(chunk.count);
    } catch (...) {
      turns.fail();
      throw;
    }
  });
}

uint32_t merge_parts(BuiltNodes& built, const BuildSettings& settings, const PartLog& log,
                     const DataFile& tree, StageProgress& progress) {
  std::vector<VoxelSum> none;
  const uint32_t root =
      Merger(built, settings, log, tree).merge(0, log.parts().size(), nullptr, none);
  progress.add(1);
  return root;
}

}  // namespace wellspring::scan
