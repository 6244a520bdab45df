// SPDX-License-Identifier: Apache-2.0
// The chunks of a LAZ file, each of which is decoded by itself: how records are coded, where chunks
// lie, and their decoder.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scan/las/laz_items.h"

namespace wellspring::scan {

struct LazLayout {
  bool has_chunks = true;      // false: all points are one chunk, without a table (LASzip 1)
  bool is_layered = false;     // each attribute is a stream of its own
  uint32_t chunk_points = 0;   // every chunk but the last has so many; 0: the table says it
  std::vector<LazItem> items;  // in a record's order

  size_t record_bytes() const;
};

// Reads the record of the file's header that LASzip left. Throws LoadError if it is damaged, or if
// something in it cannot be decoded.
LazLayout load_laz_layout(const std::string& file, std::span<const uint8_t> record);

struct LazChunk {
  uint64_t begin = 0, end = 0;  // bytes of the file
  uint64_t points = 0;
};

// Finds the chunks of a file whose points begin at byte `begin`, in order; they have at most
// `points` together. Throws LoadError if their table is damaged.
std::vector<LazChunk> load_laz_chunks(const std::string& file, std::span<const uint8_t> bytes,
                                      uint64_t begin, uint64_t points, const LazLayout& layout);

// Decodes the records of one chunk in order. Borrows the layout and the chunk's bytes.
class LazChunkDecoder {
 public:
  // `where` names the chunk for errors. Throws LoadError if its sizes are wrong.
  LazChunkDecoder(std::string file, std::string where, const LazLayout& layout,
                  std::span<const uint8_t> bytes, uint64_t points);
  ~LazChunkDecoder();
  LazChunkDecoder(const LazChunkDecoder&) = delete;
  LazChunkDecoder& operator=(const LazChunkDecoder&) = delete;

  uint64_t left() const { return left_; }
  // Writes the next records, at most left(). Throws LoadError if the chunk is damaged.
  void read(uint8_t* records, size_t count);

 private:
  struct Items;
  [[noreturn]] void fail(const std::string& what) const;
  void begin_pointwise();
  void begin_layers();

  std::string file_, where_;
  const LazLayout& layout_;
  std::span<const uint8_t> bytes_;
  uint64_t left_;
  size_t record_bytes_;
  std::unique_ptr<Items> items_;  // none before the first point
};

}  // namespace wellspring::scan
