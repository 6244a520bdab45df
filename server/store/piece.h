// SPDX-License-Identifier: Apache-2.0
// Says what a piece of large data is (a tile of a picture, a brick of a volume, a node of a scan),
// how it is named, and who fetches it.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "base/layers.h"

namespace wellspring::store {

// Names a piece: its source (1 to 1023, 0: none), its level of detail (0 to 63, 0 is the finest),
// and its place there, column and row.
struct PieceKey {
  uint64_t bits = 0;

  PieceKey() = default;
  PieceKey(int source, int level, uint32_t column, uint32_t row)
      : bits(uint64_t(source) << 54 | uint64_t(level) << 48 | uint64_t(row & 0xffffff) << 24 |
             uint64_t(column & 0xffffff)) {}
  int source() const { return int(bits >> 54); }
  int level() const { return int(bits >> 48 & 63); }
  uint32_t column() const { return uint32_t(bits & 0xffffff); }
  uint32_t row() const { return uint32_t(bits >> 24 & 0xffffff); }
  bool operator==(const PieceKey&) const = default;
};
inline constexpr int most_sources = 1023;
inline constexpr uint32_t most_pieces_a_side = 1 << 24;

// Holds a piece's decoded bytes. A tile of a picture has 4 bytes a texel, RGBA in sRGB codes, rows
// from the top.
struct Piece {
  int width = 0, height = 0;
  std::vector<uint8_t> bytes;
};

// Holds what a source answers. No piece: there is none at this place; that, too, is true only for a
// while. From `soft` seconds after it was fetched on, a piece is fetched again; from `hard` on it
// is not shown any more.
struct Fetched {
  std::shared_ptr<const Piece> piece;
  double soft = std::numeric_limits<double>::infinity();
  double hard = std::numeric_limits<double>::infinity();
};

// Fetches pieces; several threads call at once, and may have to wait long for a disk.
class PieceSource {
 public:
  virtual ~PieceSource() = default;
  // Throws LoadError if the piece cannot be read.
  virtual Fetched fetch(PieceKey key) const = 0;
};

}  // namespace wellspring::store
