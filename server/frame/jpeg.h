// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes JPEG by libjpeg-turbo (TurboJPEG API), with one handle per thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "frame/frame.h"

namespace wellspring::frame {

// Cuts a picture into tiles: finds which of them differ from those of another picture, and few
// rectangles that cover some of them.

struct ImagePart {
  int x = 0, y = 0, width = 0, height = 0;  // pixels from the upper left
  bool operator==(const ImagePart&) const = default;
};

inline constexpr int tile_side = 32;  // pixels; whole JPEG blocks, of subsampled pictures, too

struct TileGrid {
  int width = 0, height = 0;  // size of the picture, pixels
  int columns() const { return (width + tile_side - 1) / tile_side; }
  int rows() const { return (height + tile_side - 1) / tile_side; }
  size_t size() const { return size_t(columns()) * size_t(rows()); }
  ImagePart part(size_t tile) const;  // row by row; the last of a row or column may be smaller
};

// Returns whether any byte there differs by more than `tolerance`. Both pictures are of one size.
bool differs(const Image8& a, const Image8& b, const ImagePart& part, int tolerance);
// Returns rectangles of whole tiles, none over another, that cover all tiles whose `wanted` is not
// 0: exactly these, or at most `most` rectangles with some of the other tiles, if that makes fewer
// and is cheap.
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted);
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted, size_t most);
// Returns the tiles of such a rectangle.
std::vector<size_t> tiles_in(const TileGrid& grid, const ImagePart& part);
void copy_part(const Image8& from, const ImagePart& part, Image8& to);

// Shrinks a picture: each new pixel is the mean of the area that it covers.

// width and height: at least 1, at most the picture's. Bytes are averaged as they are, in sRGB: a
// picture that is shown small for a moment need not be exact.
Image8 shrink(const Image8& image, int width, int height);

// Encodes a picture. quality: 1..100; full_chroma: 4:4:4 instead of 4:2:0. Overwrites what follows
// the first `skip` bytes of `out`, which is grown to hold them; nothing but `out` is kept
// afterwards.
void encode_jpeg(const Image8& image, int quality, bool full_chroma, std::vector<uint8_t>& out,
                 size_t skip = 0);
// Encodes a part of the picture likewise; it must lie within the picture.
void encode_jpeg(const Image8& image, const ImagePart& part, int quality, bool full_chroma,
                 std::vector<uint8_t>& out, size_t skip = 0);
// Inserts a comment of at most 65533 bytes (longer ones are cut) behind the beginning of a JPEG
// file.
void add_jpeg_comment(const std::string& comment, std::vector<uint8_t>& jpeg);
// Throws LoadError{file,...} when the bytes are no JPEG or larger than 16384 a side.
Image8 decode_jpeg(std::span<const uint8_t> bytes, const char* file);

}  // namespace wellspring::frame
