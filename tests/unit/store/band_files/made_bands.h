// SPDX-License-Identifier: Apache-2.0
// Files of bands that tests make.
#pragma once
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "store/bands/band_view.h"

namespace wellspring::test {

// Describes a TIFF of bands. tile: 0 for strips of 16 rows.
struct MadeBands {
  int width = 40, height = 24, bands = 3, tile = 16;
  store::BandCode code = store::BandCode::u16;
  bool planar = false, pages = false;  // pages: a page for each band
  int photometric = PHOTOMETRIC_MINISBLACK, orientation = 1;
  std::string description;
  std::function<std::string(int band)> page_name = [](int) { return std::string(); };
  // The code of a texel; of floats itself.
  std::function<double(int x, int y, int band)> value = [](int, int, int) { return 0.0; };
};

inline void write_band_page(TIFF* tiff, const MadeBands& made, int first, int count) {
  const int bytes = store::bytes_of(made.code);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, made.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, made.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, count);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes);
  if (made.code == store::BandCode::f32)
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, made.photometric);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, made.orientation);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG,
               made.planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
  if (!made.description.empty())
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, made.description.c_str());
  if (const std::string name = made.page_name(first); !name.empty())
    TIFFSetField(tiff, TIFFTAG_PAGENAME, name.c_str());
  if (made.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, made.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, made.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 16);
  }
  const int wide = made.tile > 0 ? made.tile : made.width, high = made.tile > 0 ? made.tile : 16;
  const int planes = made.planar ? count : 1, each = made.planar ? 1 : count;
  for (int plane = 0; plane < planes; plane++)
    for (int y0 = 0; y0 < made.height; y0 += high)
      for (int x0 = 0; x0 < made.width; x0 += wide) {
        std::vector<uint8_t> block;
        const int rows = made.tile > 0 ? high : std::min(high, made.height - y0);
        for (int y = y0; y < y0 + rows; y++)
          for (int x = x0; x < x0 + wide; x++)
            for (int band = first + plane; band < first + plane + each; band++) {
              const double value =
                  made.value(std::min(x, made.width - 1), std::min(y, made.height - 1), band);
              const auto code8 = uint8_t(value);
              const auto code16 = uint16_t(value);
              const auto real = float(value);
              const void* from = made.code == store::BandCode::u8 ? static_cast<const void*>(&code8)
                                 : made.code == store::BandCode::u16
                                     ? static_cast<const void*>(&code16)
                                     : &real;
              block.resize(block.size() + size_t(bytes));
              std::memcpy(&block[block.size() - size_t(bytes)], from, size_t(bytes));
            }
        const uint32_t x = uint32_t(x0), y = uint32_t(y0);
        if (made.tile > 0)
          TIFFWriteEncodedTile(tiff, TIFFComputeTile(tiff, x, y, 0, uint16_t(plane)), block.data(),
                               tmsize_t(block.size()));
        else
          TIFFWriteEncodedStrip(tiff, TIFFComputeStrip(tiff, y, uint16_t(plane)), block.data(),
                                tmsize_t(block.size()));
      }
  TIFFWriteDirectory(tiff);
}

inline std::string write_bands_tiff(const std::string& file, const MadeBands& made) {
  TIFF* tiff = TIFFOpen(file.c_str(), "w");
  if (made.pages)
    for (int band = 0; band < made.bands; band++) write_band_page(tiff, made, band, 1);
  else write_band_page(tiff, made, 0, made.bands);
  TIFFClose(tiff);
  return file;
}

// Returns JSON of so many wavelengths from `first` nm on.
inline std::string wavelengths_json(int count, double first = 400, double step = 10) {
  store::Bands bands;
  for (int i = 0; i < count; i++) bands.nm.push_back(first + step * i);
  return store::write_bands(bands);
}

}  // namespace wellspring::test
