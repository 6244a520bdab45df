// SPDX-License-Identifier: Apache-2.0
// Reads blocks (tiles or strips) of a TIFF's pages as RGBA in sRGB, by libtiff. Any number of
// threads may read at once: each borrows a handle of its own on the one open file.
//
// Pages are grey (1, 2, 4, 8, 16 bits), palettes, RGB, CMYK (8, 16) or YCbCr, with alpha or
// without, compressed as JPEG, deflate, LZW, PackBits, CCITT, Zstandard, WebP or not at all. 16
// bits become 8.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "store/format/color_profile.h"
#include "store/format/stored_jpeg.h"
#include "store/picture/texels.h"

namespace wellspring::store {

// Describes a page. Its blocks are stored row by row; those at the right and lower edge reach over.
struct TiffPage {
  enum class Way : uint8_t { table, rgb, cmyk, any };         // any: libtiff converts
  enum class Alpha : uint8_t { none, straight, multiplied };  // multiplied: into colours

  std::string name;                       // such as "page 3", for errors
  uint64_t offset = 0;                    // bytes in the file
  int64_t width = 0, height = 0;          // texels
  int block_width = 0, block_height = 0;  // texels
  bool is_tiled = false;                  // else blocks are strips
  bool is_planar = false;                 // whether each channel has blocks of its own
  bool converts_jpeg = false;             // whether libtiff turns YCbCr of JPEG into RGB
  int bits = 8, channels = 1;             // bits of a channel
  int64_t most_packed = 1;                // texels' bytes that may be packed into one of the file
  Way way = Way::table;
  Alpha alpha = Alpha::none;
  Orientation orientation;
  std::optional<JpegColors> jpeg;        // colours of blocks that browsers can show as they are
  std::array<uint8_t, 1024> table = {};  // RGBA of each code, for pages of one channel
};

class TiffFile {
 public:
  // Throws LoadError unless the file is a TIFF.
  explicit TiffFile(const std::string& file);
  ~TiffFile();
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  // Returns the first page, and then those smaller pages of the same picture that have tiles, the
  // largest first: from the first page's SubIFDs, else from among the further pages.
  std::vector<TiffPage> read_pages();
  // Says whether a block is there. Files may leave out empty ones.
  std::optional<Piece> read_block(const TiffPage& page, int column, int row) const;
  // Returns a tile as a JPEG file, if its page has `jpeg` and nothing has to be decoded; else
  // nothing.
  std::vector<uint8_t> read_jpeg(const TiffPage& page, int column, int row) const;
  int64_t size() const { return size_; }  // bytes

 private:
  struct Handle;
  struct Lease;
  std::unique_ptr<Handle> open_handle() const;
  TiffPage describe(Handle& handle, const std::string& name) const;

  std::string file_;
  int descriptor_ = -1;
  int64_t size_ = 0;
  std::shared_ptr<const ColorProfile> profile_;  // the first page's, for all; null: none
  bool is_srgb_ = true;                          // whether that changes no colour
  mutable std::mutex mutex_;                     // guards idle_
  mutable std::vector<std::unique_ptr<Handle>> idle_;
};

}  // namespace wellspring::store
