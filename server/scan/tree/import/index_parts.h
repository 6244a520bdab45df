// SPDX-License-Identifier: Apache-2.0
// Stages of an import after points are in chunks: chunks become parts of the tree on all cores,
// in the order of chunks in the file, and levels above them are made of the parts' sums.
#pragma once
#include <cstdint>
#include <vector>

#include "scan/tree/import/build_chunk.h"
#include "scan/tree/data_file.h"
#include "scan/tree/import/work.h"

namespace wellspring::scan {

// A point in the memory of this stage takes about so many bytes.
inline constexpr uint64_t built_point_bytes = 110;

// All nodes so far; children are numbers here, and offsets are the file's.
struct BuiltNodes {
  std::vector<BuiltNode> nodes;
  uint64_t end = 0;  // bytes of the file that are taken
};

// Says where a part is: its root among all nodes, its sums in the log.
struct PartPlace {
  uint32_t root = 0;
  uint64_t sums_at = 0;
  uint32_t sums = 0;
};

// Keeps in a file which parts are done, so that they need not be made again.
class PartLog {
 public:
  explicit PartLog(DataFile file) : file_(std::move(file)) {}
  // Takes the parts that are whole, from the first one on.
  void resume(BuiltNodes& built);
  // Adds a part whose bytes are in the tree's file already.
  void add(BuiltNodes& built, const BuiltPart& part, uint64_t begin);
  const std::vector<PartPlace>& parts() const { return parts_; }
  void read_sums(size_t part, std::vector<VoxelSum>& sums) const;

 private:
  struct Entry;
  void take(BuiltNodes& built, const Entry& entry, std::vector<BuiltNode> nodes, uint64_t at);
  DataFile file_;
  std::vector<PartPlace> parts_;
  uint64_t end_ = 0;
};

// Makes the parts of all chunks that `log` has not. Throws LoadError.
void index_chunks(PartLog& log, BuiltNodes& built, const BuildSettings& settings,
                  const std::vector<Chunk>& chunks, const DataFile& points, const DataFile& tree,
                  uint64_t memory, HeldBytes& held, StageProgress& progress);

// Makes the nodes above the parts, and returns the root's number.
uint32_t merge_parts(BuiltNodes& built, const BuildSettings& settings, const PartLog& log,
                     const DataFile& tree, StageProgress& progress);

}  // namespace wellspring::scan
