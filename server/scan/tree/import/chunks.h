// SPDX-License-Identifier: Apache-2.0
// The second stage of an import: points are counted on a grid, cells with few points are put
// together to chunks, and points are distributed to these (Schuetz et al. 2020, section 4.1).
#pragma once
#include <cstdint>
#include <vector>

#include "scan/tree/data_file.h"
#include "scan/tree/import/read_source.h"
#include "scan/tree/import/work.h"

namespace wellspring::scan {

// Says where the tree's root lies in the frame of the sources.
struct TreeCube {
  dvec3 origin{0}, corner{0};  // metres; the corner is relative to the origin
  double edge = 1;
};

// A point in a chunk. Its place is in steps of edge / 2^48 from the root's corner.
struct ChunkPoint {
  uint32_t low[3];
  uint16_t high[3];
  uint16_t normal;
  uint32_t color;    // as NodePoints has it
  uint16_t station;  // numbered over all sources
  uint8_t classification;
  uint8_t none;

  uint64_t place(int axis) const { return uint64_t(high[axis]) << 32 | low[axis]; }
};
static_assert(sizeof(ChunkPoint) == 28);

inline constexpr uint16_t no_station = 65535;

// A cube with points, no more than are indexed at once.
struct Chunk {
  uint32_t level = 0;
  uint32_t cell[3] = {0, 0, 0};  // as NodeRecord
  uint64_t count = 0;
  uint64_t first = 0;  // number of its first record in the file of chunks
};

// Gives the points of the first stage as chunks have them, in order and as often as wanted.
class PointStream {
 public:
  virtual ~PointStream() = default;
  virtual void begin() = 0;
  // Returns the number of points; 0: there are no more.
  virtual size_t read(ChunkPoint* to, size_t most) = 0;
};

class ReadPointStream : public PointStream {
 public:
  ReadPointStream(const std::vector<DataFile>& files, const std::vector<SourceFacts>& facts,
                  const TreeCube& cube);
  void begin() override { source_ = 0, at_ = 0; }
  size_t read(ChunkPoint* to, size_t most) override;

 private:
  const std::vector<DataFile>& files_;
  const std::vector<SourceFacts>& facts_;
  const TreeCube cube_;
  std::vector<uint16_t> color_max_, intensity_max_, first_station_;
  std::vector<ReadPoint> records_;
  size_t source_ = 0;
  uint64_t at_ = 0;
};

// Distributes all points to `to`, and returns its chunks in Z-order. Chunks have at most `limit`
// points, or at most `piled` if cubes of the deepest level hold more. Throws LoadError if they do
// not.
std::vector<Chunk> distribute(PointStream& points, uint64_t limit, uint64_t piled, uint64_t memory,
                              const DataFile& to, HeldBytes& held, StageProgress& progress);

}  // namespace wellspring::scan
