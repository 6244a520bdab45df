// SPDX-License-Identifier: Apache-2.0
// Describes a page of a TIFF, as far as its texels are read.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "store/bands/band_view.h"
#include "store/format/stored_jpeg.h"
#include "store/picture/texels.h"

namespace wellspring::store {

// Describes a page. Its blocks are stored row by row; those at the right and lower edge reach over.
struct TiffPage {
  enum class Way : uint8_t { table, rgb, cmyk, any, bands };  // any: libtiff converts
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
  bool is_float = false;
  Way way = Way::table;
  Alpha alpha = Alpha::none;
  Orientation orientation;
  std::optional<JpegColors> jpeg;        // colours of blocks that browsers can show as they are
  std::array<uint8_t, 1024> table = {};  // RGBA of each code, for pages of one channel
};

// Returns the kind of a page's codes.
BandCode code_of(const TiffPage& page);
// Refuses a page of more texels than may be packed into a file of so many bytes.
void check_stored(const TiffPage& page, int64_t file_bytes, const std::string& file);

}  // namespace wellspring::store
