// SPDX-License-Identifier: Apache-2.0
// A volume that is larger than memory, as a file: levels of detail, each cut into bricks of 32^3
// samples with a skirt of one more on every side, so that places in a brick, and those of finer
// bricks within it, are interpolated from it alone. A brick has codes and packed normals; those of
// one code alone have no data. Tables of bricks and ranges of cells are read at once, bricks when
// they are wanted.
//
// The file: a head, records of bricks, entries of all bricks level by level, ranges of all cells
// level by level. Numbers are little-endian. Bricks are read, not mapped: a file that others cut
// off is then an error, not a signal, and the system's copies do not count as this process's.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "volume/codes.h"

namespace wellspring::volume {

inline constexpr int inner_side = 32, stored_side = inner_side + 2;
inline constexpr int stored_row = stored_side, stored_slice = stored_side * stored_side;
inline constexpr int stored_samples = stored_slice * stored_side;
inline constexpr uint32_t no_record = 0xffffffff;

// Holds a level's bricks: brick (x, y, z) is for places from its first sample, 32 * (x, y, z), up
// to the next one's; its stored samples begin one before.
struct BrickLevel {
  glm::ivec3 size{1};    // samples
  glm::ivec3 bricks{1};  // along the axes
  size_t first = 0;      // number of its brick (0, 0, 0) among those of all levels

  size_t number_of(glm::ivec3 brick) const {
    return first + (size_t(brick.z) * size_t(bricks.y) + size_t(brick.y)) * size_t(bricks.x) +
           size_t(brick.x);
  }
  size_t count() const { return size_t(bricks.x) * size_t(bricks.y) * size_t(bricks.z); }
};
std::vector<BrickLevel> brick_levels(glm::ivec3 finest);

struct BrickEntry {
  uint16_t least = 0, most = 0;  // its codes, with the skirt, are these and between
  uint32_t record = no_record;   // none: all codes are `least`, and no normal is anywhere
};

// Begins a file.
struct BrickHead {
  std::array<char, 8> magic;
  int32_t size[3];   // samples
  uint32_t records;  // bricks that have data
  double low, high;  // CodeScale
  double to_metres[16];
  uint64_t code_counts[code_bins];
};
inline constexpr std::array<char, 8> brick_magic{'W', 'S', 'b', 'r', 'i', 'c', 'k', '1'};
inline constexpr size_t stored_code_bytes = stored_samples * sizeof(uint16_t),
                        record_bytes = stored_code_bytes + stored_samples * sizeof(uint32_t);

struct BrickFile {
  std::string path;
  CodeScale scale;
  glm::dmat4 to_metres{1};
  std::vector<uint64_t> code_counts;  // the finest level has so many, by code_bins even bins
  std::vector<BrickLevel> levels;     // the finest first
  std::vector<BrickEntry> entries;    // all levels' bricks, in turn
  std::vector<std::vector<CodeRange>> ranges;  // each level's cells'
  std::shared_ptr<const int> descriptor;

  // Reads a brick's codes and, unless null, its normals; x fastest, with the skirt. Throws
  // LoadError if the file does not hold them any more. Any thread.
  void read(const BrickEntry& entry, uint16_t* codes, uint32_t* normals) const;
  // Lets the system fetch a brick's data, without waiting.
  void expect(const BrickEntry& entry) const;
};

// Returns whether the file says of itself that it is one of bricks.
bool is_brick_file(const std::string& path);
// Throws LoadError that names file and place.
BrickFile open_bricks(const std::string& path);

// Returns all codes of a level, x fastest. Throws LoadError.
std::vector<uint16_t> read_level_codes(const BrickFile& file, int level);

}  // namespace wellspring::volume
