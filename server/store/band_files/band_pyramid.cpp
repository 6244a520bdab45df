// SPDX-License-Identifier: Apache-2.0
#include "store/band_files/band_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <optional>
#include <tiffio.h>

#include "base/load_error.h"
#include "store/picture/pyramid.h"
#include "store/picture/texels.h"

namespace wellspring::store {
namespace {

constexpr int tile_side = 256;  // texels

// Holds a TIFF that is written, and the first thing that went wrong.
class TiffWriter {
 public:
  // mode: libtiff's, "w8" for a new BigTIFF, "a" for more pages.
  TiffWriter(const std::string& file, const char* mode) : file_(file) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_error, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, this);
    tiff_ = TIFFOpenExt(file.c_str(), mode, options);
    TIFFOpenOptionsFree(options);
    if (!tiff_) fail();
  }
  ~TiffWriter() { TIFFClose(tiff_); }
  TiffWriter(const TiffWriter&) = delete;
  TiffWriter& operator=(const TiffWriter&) = delete;
  TIFF* get() const { return tiff_; }
  [[noreturn]] void fail() const { throw LoadError(file_, "", "cannot be written: " + problem_); }

 private:
  static int keep_error(TIFF*, void* self, const char*, const char* format, va_list values) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, values);
    std::string& problem = static_cast<TiffWriter*>(self)->problem_;
    if (problem.empty()) problem = text;
    return 1;
  }
  static int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

  const std::string file_;
  std::string problem_;
  TIFF* tiff_ = nullptr;
};

// Says how reflectances become codes.
struct Coding {
  int bits, quality;

  Bands describe(const Bands& from) const {
    Bands bands;
    bands.nm = from.nm, bands.source = from.source;
    if (bits == 8) bands.gamma = 2;
    return bands;
  }
  void put(float reflectance, uint8_t* to) const {
    const float r = std::clamp(reflectance, 0.0f, 1.0f);
    if (bits == 8) {
      *to = uint8_t(std::sqrt(r) * 255 + 0.5f);
    } else {
      const auto code = uint16_t(r * 65535 + 0.5f);
      std::memcpy(to, &code, 2);
    }
  }
};

// Returns rows of the next smaller version: each texel is the mean of the area that it covers.
void shrink(const BandSource& from, const std::vector<Covered>& columns,
            const std::vector<Covered>& rows, int64_t top, int count, std::vector<float>& to) {
  const size_t bands = from.bands().nm.size(), width = columns.size();
  const Covered& last = rows[size_t(top + count - 1)];
  const int first = rows[size_t(top)].first, high = last.first + last.count - first;
  std::vector<float> read;
  from.read(first, high, read);
  to.assign(bands * size_t(count) * width, 0);
  float* at = to.data();
  for (size_t band = 0; band < bands; band++)
    for (int y = 0; y < count; y++, at += width) {
      const Covered& down = rows[size_t(top + y)];
      for (int j = 0; j < down.count; j++) {
        const float* line =
            &read[(band * size_t(high) + size_t(down.first + j - first)) * size_t(from.width())];
        for (size_t x = 0; x < width; x++)
          for (int i = 0; i < columns[x].count; i++)
            at[x] += down.share[j] * columns[x].share[i] * line[columns[x].first + i];
      }
    }
}

// Writes one page by `read`, which gives rows of all bands.
class PageWriter {
 public:
  PageWriter(const TiffWriter& writer, int64_t width, int64_t height, size_t bands, Coding coding)
      : writer_(writer),
        tiff_(writer.get()),
        width_(width),
        height_(height),
        bands_(bands),
        coding_(coding) {
    TIFFSetField(tiff_, TIFFTAG_IMAGEWIDTH, uint32_t(width));
    TIFFSetField(tiff_, TIFFTAG_IMAGELENGTH, uint32_t(height));
    TIFFSetField(tiff_, TIFFTAG_TILEWIDTH, tile_side);
    TIFFSetField(tiff_, TIFFTAG_TILELENGTH, tile_side);
    TIFFSetField(tiff_, TIFFTAG_SAMPLESPERPIXEL, int(bands));
    TIFFSetField(tiff_, TIFFTAG_BITSPERSAMPLE, coding.bits);
    TIFFSetField(tiff_, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff_, TIFFTAG_PLANARCONFIG, PLANARCONFIG_SEPARATE);
    const std::vector<uint16_t> more(bands - 1, EXTRASAMPLE_UNSPECIFIED);
    if (!more.empty()) TIFFSetField(tiff_, TIFFTAG_EXTRASAMPLES, int(more.size()), more.data());
    if (coding.quality > 0) {
      TIFFSetField(tiff_, TIFFTAG_COMPRESSION, COMPRESSION_JPEG);
      TIFFSetField(tiff_, TIFFTAG_JPEGQUALITY, coding.quality);
    } else {
      // Zstandard is unpacked in two thirds of deflate's time, at the same size.
      TIFFSetField(
          tiff_, TIFFTAG_COMPRESSION,
          TIFFIsCODECConfigured(COMPRESSION_ZSTD) ? COMPRESSION_ZSTD : COMPRESSION_ADOBE_DEFLATE);
      TIFFSetField(tiff_, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    }
  }
  // Writes a row of tiles. Those at the edges repeat the last texel.
  void write_row(int64_t top, int rows, const std::vector<float>& reflectances) {
    const size_t code_bytes = size_t(coding_.bits / 8);
    std::vector<uint8_t> codes(size_t(tile_side) * tile_side * code_bytes);
    for (size_t band = 0; band < bands_; band++)
      for (int64_t left = 0; left < width_; left += tile_side) {
        uint8_t* to = codes.data();
        for (int y = 0; y < tile_side; y++) {
          const size_t row = band * size_t(rows) + size_t(std::min(y, rows - 1));
          const float* from = &reflectances[row * size_t(width_)];
          for (int64_t x = left; x < left + tile_side; x++, to += code_bytes)
            coding_.put(from[std::min(x, width_ - 1)], to);
        }
        const uint32_t tile =
            TIFFComputeTile(tiff_, uint32_t(left), uint32_t(top), 0, uint16_t(band));
        if (TIFFWriteEncodedTile(tiff_, tile, codes.data(), tmsize_t(codes.size())) < 0)
          writer_.fail();
      }
  }
  void finish() {
    if (!TIFFWriteDirectory(tiff_)) writer_.fail();
  }

 private:
  const TiffWriter& writer_;
  TIFF* const tiff_;
  const int64_t width_, height_;
  const size_t bands_;
  const Coding coding_;
};

}  // namespace

BandPyramidStats write_band_pyramid(const BandSource& source, const std::string& file,
                                    const BandPyramidSettings& settings) {
  BandPyramidStats stats;
  const Coding coding{settings.quality > 0 ? 8 : settings.bits, settings.quality};
  const size_t bands = source.bands().nm.size();
  int64_t width = source.width(), height = source.height();
  std::vector<float> rows;
  int64_t above = 0, below = 0;
  for (;; stats.levels++) {
    // The version before is read from what was written of it.
    const bool is_first = stats.levels == 0;
    const TiffWriter tiff(file, is_first ? "w8" : "a");
    std::optional<BandSource> finer;
    std::vector<Covered> columns, lines;
    if (!is_first) {
      finer.emplace(file, stats.levels - 1);
      columns = cover(int(finer->width()), int(width));
      lines = cover(int(finer->height()), int(height));
    }
    PageWriter page(tiff, width, height, bands, coding);
    if (is_first)
      TIFFSetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION,
                   write_bands(coding.describe(source.bands())).c_str());
    else TIFFSetField(tiff.get(), TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
    for (int64_t top = 0; top < height; top += tile_side) {
      const int count = int(std::min<int64_t>(tile_side, height - top));
      if (is_first) {
        source.read(top, count, rows);
        above += std::ranges::count_if(rows, [](float r) { return r > 1; });
        below += std::ranges::count_if(rows, [](float r) { return r < 0; });
      } else {
        shrink(*finer, columns, lines, top, count, rows);
      }
      page.write_row(top, count, rows);
      if (is_first) settings.progress(0.75 * double(top + count) / double(height));
    }
    page.finish();
    if (std::max(width, height) <= coarsest_side) break;
    width = (width + 1) / 2, height = (height + 1) / 2;
  }
  stats.levels++;
  const double all = double(source.width()) * double(source.height()) * double(bands);
  stats.above = double(above) / all, stats.below = double(below) / all;
  settings.progress(1);
  return stats;
}

}  // namespace wellspring::store
