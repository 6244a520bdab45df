// SPDX-License-Identifier: Apache-2.0
// Reads blocks (tiles or strips) of a TIFF's pages as RGBA in sRGB, by libtiff. Any number of
// threads may read at once: each borrows a handle of its own on the one open file.
//
// Pages are grey (1, 2, 4, 8, 16 bits), palettes, RGB, CMYK (8, 16) or YCbCr, with alpha or
// without, compressed as JPEG, deflate, LZW, PackBits, CCITT, Zstandard, WebP or not at all. 16
// bits become 8. Or they have many bands (store/bands/bands.h), of 8, 16 bits or floats.
#pragma once
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "store/format/color_profile.h"
#include "store/format/tiff_page.h"
#include "store/picture/texels.h"

namespace wellspring::store {

struct TiffHandle;  // store/format/tiff_handle.h

class TiffFile {
 public:
  // `view`: how a picture of bands is shown; others know only the first one. Throws LoadError
  // unless the file is a TIFF.
  explicit TiffFile(const std::string& file, BandView view = {});
  ~TiffFile();
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  // Returns the first page, and then those smaller pages of the same picture that have tiles, the
  // largest first: from the first page's SubIFDs, else from among the further pages.
  std::vector<TiffPage> read_pages();
  // Returns a block as RGBA; nothing if it is not there: files may leave out empty ones.
  std::optional<Piece> read_block(const TiffPage& page, int column, int row) const;
  // Returns a tile as a JPEG file, if its page has `jpeg` and nothing has to be decoded; else
  // nothing.
  std::vector<uint8_t> read_jpeg(const TiffPage& page, int column, int row) const;
  int64_t size() const { return size_; }  // bytes

  // Returns all pages as pages of bands, which nobody need have described, and what their PageName
  // says; with read_codes() alone.
  struct BandPage {
    TiffPage page;
    std::string page_name;
  };
  std::vector<BandPage> read_band_pages();
  // Returns a block's codes: of the channel if the page is planar, else of all channels.
  std::vector<uint8_t> read_codes(const TiffPage& page, int column, int row, int channel) const;
  // Returns the first page's ImageDescription.
  std::string description() const;

 private:
  struct Lease;
  std::unique_ptr<TiffHandle> open_handle() const;
  TiffPage describe(TiffHandle& handle, const std::string& name, bool has_bands) const;
  void find_band_weights();
  Piece mix_block(const Lease& lease, const TiffPage& page, int column, int row) const;

  std::string file_;
  BandView view_;
  std::optional<Bands> bands_;
  BandWeights weights_;
  int descriptor_ = -1;
  int64_t size_ = 0;
  std::shared_ptr<const ColorProfile> profile_;  // the first page's, for all; null: none
  bool is_srgb_ = true;                          // whether that changes no colour
  mutable std::mutex mutex_;                     // guards idle_
  mutable std::vector<std::unique_ptr<TiffHandle>> idle_;
};

}  // namespace wellspring::store
