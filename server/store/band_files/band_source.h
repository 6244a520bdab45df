// SPDX-License-Identifier: Apache-2.0
// Reads the bands of a picture however they are delivered: samples or pages of a TIFF, or a PNG or
// TIFF for each.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "store/bands/band_view.h"
#include "store/format/tiff_file.h"

namespace wellspring::store {

// Files of PNG are read whole; all of them together have at most so many bytes.
inline constexpr int64_t most_png_bytes = int64_t(4) << 30;

// Reads rows of all bands. One thread at a time.
class BandSource {
 public:
  // `path`: NAME.bands.json, or a TIFF, described by its ImageDescription, NAME.bands.json beside
  // it or the names of its pages; or a folder with one .json, or with files whose names tell their
  // wavelengths ("..450nm.png"). `level`: of a TIFF's smaller versions, 0: none of them. Throws
  // LoadError that names file and place: bands that are missing, of other sizes, coloured.
  explicit BandSource(const std::string& path, int level = 0);

  const Bands& bands() const { return bands_; }
  int64_t width() const { return width_; }
  int64_t height() const { return height_; }
  // Fills rows of one band after the other with reflectances, from `top` on; they may lie beyond 0
  // to 1. Throws LoadError for a block that cannot be read, and for values that are no number.
  void read(int64_t top, int rows, std::vector<float>& reflectances) const;

 private:
  // Holds where a band's codes are.
  struct Band {
    std::string file;
    BandCode code = BandCode::u8;
    std::vector<uint8_t> codes;      // those of a PNG; else
    std::shared_ptr<TiffFile> tiff;  // a channel of a page
    TiffPage page;
    int channel = 0;
  };
  // Holds the block of codes that was read last.
  struct Block {
    const TiffFile* tiff = nullptr;
    uint64_t page = 0;
    int column = 0, row = 0, plane = -1;
    std::vector<uint8_t> codes;
  };
  void open_json(const std::string& file);
  void open_folder(const std::string& folder);
  void open_tiff(const std::string& file, int level);
  void open_files(const std::string& folder, const std::vector<std::string>& files);
  void add(Band band, int64_t width, int64_t height);
  void add_png(const std::string& file);
  void add_tiff_page(const std::string& file);
  void add_channels(const std::shared_ptr<TiffFile>& tiff, const std::string& file,
                    const TiffPage& page);
  void read_blocks(size_t band, int64_t top, int rows, std::span<float> to) const;

  Bands bands_;
  std::vector<Band> all_;
  int64_t width_ = 0, height_ = 0;
  int64_t png_bytes_ = 0;
  mutable Block last_;
};

}  // namespace wellspring::store
