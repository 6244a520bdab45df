// SPDX-License-Identifier: Apache-2.0
// A point as it is drawn, and the pieces that points come in.
#pragma once
#include <cstddef>
#include <cstdint>

#include "scan/camera.h"
#include "scan/tree/node_points.h"

namespace wellspring::scan {

// The disc covers sampling places at d = (dx, dy) pixels from its middle for which q = |d|^2 /
// radius^2 + (lean . d)^2 is at most 1; its depth there is depth + slope * (lean . d).
struct alignas(32) Disc {
  // Place from the sampling place of pixel 0, in 1/256 of a pixel, times 256, plus the half extent
  // of the ellipse in 1/4 of a pixel; extent 0: the disc is the pixel next to it.
  int32_t x, y;
  float depth;
  float lean_x, lean_y;
  float radius;
  float slope;
  uint32_t point;  // number of the piece times piece_points plus number in the piece
};
static_assert(sizeof(Disc) == 32);
// Returns its middle, pixels from the sampling place of pixel 0.
inline vec2 place_of(const Disc& disc) {
  return vec2(float(disc.x >> 8), float(disc.y >> 8)) / 256.0f;
}

inline constexpr int tile_side = 64;
inline constexpr int piece_bits = 12, piece_points = 1 << piece_bits;
inline constexpr size_t most_pieces = size_t(1) << (32 - piece_bits);

// Up to piece_points of a node.
struct Piece {
  uint32_t node = 0, first = 0, count = 0;
};

// A run of discs of one piece that one tile shows.
struct TileDiscs {
  uint32_t tile = 0;
  uint32_t begin = 0, end = 0;  // in the piece's discs
  uint32_t area = 0;            // pixels of their boxes
};

}  // namespace wellspring::scan
