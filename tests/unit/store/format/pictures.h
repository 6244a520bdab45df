// SPDX-License-Identifier: Apache-2.0
// Pictures that tests make: a pattern in which no two texels near one another are alike, files of
// it, and what is read back.
#pragma once
#include <gtest/gtest.h>
#include <tiffio.h>

#include <functional>
#include <string>
#include <vector>

#include "base/load_error.h"
#include "image/image.h"
#include "store/open/open_picture.h"
#include "unit/folder.h"

namespace wellspring::test {

// Returns a code of a channel at a texel.
using Codes = std::function<int(int x, int y, int channel)>;

inline int pattern(int x, int y, int channel) {
  return (x * (7 + channel) + y * (13 - channel) + channel * 50) % 256;
}

// Returns the RGBA of codes; without a fourth channel alpha is 255.
inline store::Piece piece_of(int width, int height, const Codes& codes, int channels = 3) {
  store::Piece piece{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 4; c++)
        piece.bytes.push_back(uint8_t(c < channels ? codes(x, y, c) : 255));
  return piece;
}

inline std::string png_of(int width, int height, const Codes& codes) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++) image.rgb.push_back(uint8_t(codes(x, y, c)));
  const std::vector<uint8_t> bytes = encode_png(image, "", "test.png");
  return {bytes.begin(), bytes.end()};
}

// Puts the tiles of a level together, however large it is. Each must have the size that its level
// tells; absent ones are transparent.
inline store::Piece whole_level(const store::PicturePyramid& pyramid, int number) {
  const store::PyramidLevel& level = pyramid.levels()[size_t(number)];
  store::Piece whole{int(level.width), int(level.height), {}};
  whole.bytes.resize(size_t(whole.width) * size_t(whole.height) * 4);
  for (int row = 0; row < level.rows(); row++)
    for (int column = 0; column < level.columns(); column++) {
      const auto tile = pyramid.fetch({1, number, uint32_t(column), uint32_t(row)}).piece;
      if (!tile) continue;
      EXPECT_EQ(tile->width, level.width_at(column)) << column << ", " << row;
      EXPECT_EQ(tile->height, level.height_at(row)) << column << ", " << row;
      EXPECT_EQ(tile->bytes.size(), size_t(tile->width) * size_t(tile->height) * 4);
      for (int y = 0; y < tile->height; y++)
        std::copy_n(&tile->bytes[size_t(y) * size_t(tile->width) * 4], size_t(tile->width) * 4,
                    &whole.bytes[(size_t(row * level.tile_height + y) * size_t(whole.width) +
                                  size_t(column * level.tile_width)) *
                                 4]);
    }
  return whole;
}

// Expects the same texels, each code up to `tolerance`.
inline void expect_same(const store::Piece& found, const store::Piece& wanted, int tolerance = 0) {
  ASSERT_EQ(found.width, wanted.width);
  ASSERT_EQ(found.height, wanted.height);
  ASSERT_EQ(found.bytes.size(), wanted.bytes.size());
  for (size_t i = 0; i < found.bytes.size(); i++)
    ASSERT_NEAR(found.bytes[i], wanted.bytes[i], tolerance)
        << "texel " << i / 4 % size_t(found.width) << ", " << i / 4 / size_t(found.width)
        << " channel " << i % 4;
}

// Returns what opening a picture, or reading all tiles of its finest level, is refused with.
inline std::string refusal(const std::string& path) {
  try {
    whole_level(*store::open_picture(path), 0);
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

// Describes a page of a TIFF that a test writes. tile: 0 for strips of 16 rows.
struct TiffSpec {
  int width = 40, height = 24, tile = 16;
  int bits = 8, channels = 3, photometric = PHOTOMETRIC_RGB, compression = COMPRESSION_NONE;
  int planar = PLANARCONFIG_CONTIG, orientation = 1;
  int extra = -1;     // kind of the channel behind the colours
  int left_out = -1;  // number of a tile that is not written
  std::string icc;
  Codes codes = pattern;
};

// Returns a block's rows as they are stored.
inline std::vector<uint8_t> tiff_block(const TiffSpec& page, int x0, int y0, int wide, int high,
                                       int first, int count) {
  std::vector<uint8_t> bytes;
  for (int y = 0; y < high; y++) {
    int bit = 0;
    for (int x = 0; x < wide; x++)
      for (int c = first; c < first + count; c++) {
        const int code = page.codes(x0 + x, y0 + y, c);
        if (page.bits == 16) bytes.push_back(uint8_t(code)), bytes.push_back(uint8_t(code >> 8));
        else if (page.bits == 8) bytes.push_back(uint8_t(code));
        else {
          if (bit % 8 == 0) bytes.push_back(0);
          bytes.back() = uint8_t(bytes.back() | code << (8 - page.bits - bit % 8));
          bit += page.bits;
        }
      }
  }
  return bytes;
}

inline void write_tiff_page(TIFF* tiff, const TiffSpec& page, bool is_small = false) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, page.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, page.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, page.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, page.channels);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, page.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, page.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, page.planar);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, page.orientation);
  if (is_small) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
  if (!page.icc.empty())
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, uint32_t(page.icc.size()), page.icc.data());
  if (page.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<uint16_t> map[3];
    for (int c = 0; c < 3; c++)
      for (int i = 0; i < 1 << page.bits; i++) map[c].push_back(uint16_t(pattern(i, 0, c) * 257));
    TIFFSetField(tiff, TIFFTAG_COLORMAP, map[0].data(), map[1].data(), map[2].data());
  }
  if (page.extra >= 0) {
    const uint16_t extra[] = {uint16_t(page.extra)};
    TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, extra);
  }
  if (page.compression == COMPRESSION_JPEG) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    TIFFSetField(tiff, TIFFTAG_JPEGQUALITY, 95);
  }
  const bool by_plane = page.planar == PLANARCONFIG_SEPARATE;
  const int planes = by_plane ? page.channels : 1, count = by_plane ? 1 : page.channels;
  constexpr int strip = 16;
  if (page.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, page.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, page.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, strip);
  }
  const int wide = page.tile > 0 ? page.tile : page.width;
  const int high = page.tile > 0 ? page.tile : strip;
  for (int plane = 0; plane < planes; plane++)
    for (int y = 0; y < page.height; y += high)
      for (int x = 0; x < page.width; x += wide) {
        const int rows = page.tile > 0 ? high : std::min(high, page.height - y);
        auto bytes = tiff_block(page, x, y, wide, rows, plane, count);
        const auto sample = uint16_t(plane);
        const auto tile = TIFFComputeTile(tiff, uint32_t(x), uint32_t(y), 0, sample);
        if (page.tile > 0 && int(tile) == page.left_out) continue;
        if (page.tile > 0) TIFFWriteEncodedTile(tiff, tile, bytes.data(), tmsize_t(bytes.size()));
        else
          TIFFWriteEncodedStrip(tiff, TIFFComputeStrip(tiff, uint32_t(y), sample), bytes.data(),
                                tmsize_t(bytes.size()));
      }
  TIFFWriteDirectory(tiff);
}

// Writes pages; sub: all but the first are SubIFDs of it. mode: libtiff's, "w" or "w8" for BigTIFF.
inline std::string write_tiff(const Folder& folder, const std::vector<TiffSpec>& pages,
                              bool sub = false, const char* mode = "w") {
  const std::string file = folder.file("test.tif");
  TIFF* tiff = TIFFOpen(file.c_str(), mode);
  for (size_t i = 0; i < pages.size(); i++) {
    if (sub && i == 0) {
      const std::vector<uint64_t> none(pages.size() - 1);
      TIFFSetField(tiff, TIFFTAG_SUBIFD, int(none.size()), none.data());
    }
    write_tiff_page(tiff, pages[i], i > 0);
  }
  TIFFClose(tiff);
  return file;
}

}  // namespace wellspring::test
