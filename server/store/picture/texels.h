// SPDX-License-Identifier: Apache-2.0
// Moves, turns and averages the texels of pieces: RGBA in sRGB codes, rows from the top.
#pragma once
#include <cstdint>
#include <vector>

#include "image/image.h"
#include "store/piece.h"

namespace wellspring::store {

// Makes a piece of transparent black.
Piece make_piece(int width, int height);

// Takes over what a picture file holds; 16 bits become 8, rounded.
Piece to_piece(image::ImageCodes&& codes);

inline uint8_t to_8_bits(uint32_t code16) { return uint8_t((code16 * 255 + 32895) >> 16); }

// Cuts out a part, which lies within `from`.
Piece cut(const Piece& from, const image::ImagePart& part);

// Copies `part` of `from` into `into`, its upper left corner to (x, y). Leaves out what lies
// outside of either.
void paste(const Piece& from, const image::ImagePart& part, int x, int y, Piece& into);

// Says how a stored picture is shown: EXIF 2.3, section 4.6.4, tag Orientation, 1 to 8.
struct Orientation {
  int code = 1;

  bool is_upright() const { return code == 1; }
  bool swaps_sides() const { return code >= 5; }
  bool mirrors_columns() const { return code == 2 || code == 3 || code == 7 || code == 8; }
  bool mirrors_rows() const { return code == 3 || code == 4 || code == 6 || code == 7; }
};
// Turns a stored piece as it is shown.
Piece turn(Piece stored, Orientation orientation);

// Says which texels of a row, or column, a texel of a shorter one covers: up to three, by how much
// of each; the sum is 1.
struct Covered {
  int first = 0, count = 0;
  float share[3] = {};
};
// Returns it for each of `to` texels that cover `from`, at least half as many.
std::vector<Covered> cover(int from, int to);

// Writes linear colours as opaque RGBA in sRGB codes; they are cut to 0 to 1.
void write_srgb(const float* red, const float* green, const float* blue, size_t count,
                uint8_t* rgba);

// Averages a picture to half its size, rounded up, in linear light; texels count by their alpha.
// Each texel is the mean of exactly the area that it covers.
Piece halve(const Piece& from);

}  // namespace wellspring::store
