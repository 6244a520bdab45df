// SPDX-License-Identifier: Apache-2.0
// Takes JPEG files apart by their segments (ITU-T T.81, annex B) and joins them anew, so that tiles
// go to browsers as they are stored: nothing is decoded.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::store {

struct StoredJpeg {
  std::vector<uint8_t> bytes;               // empty: browsers could not read it, or it is broken
  int width = 0, height = 0, channels = 0;  // as its frame tells
};

// Names the colours of a JPEG's channels. Values are those of Adobe's marker.
enum class JpegColors : uint8_t { rgb = 0, ycc = 1, grey = 2 };

// Joins the tables and the data of a tile of a TIFF (Technical Note 2). All that the file says
// about itself is left out; Adobe's marker says what its colours are.
StoredJpeg join_tiff_jpeg(std::span<const uint8_t> tables, std::span<const uint8_t> data,
                          JpegColors colors);

// Takes a file as it is, but for what would make a browser show other texels than decode_codes()
// returns: a colour profile, an orientation.
StoredJpeg take_jpeg_file(std::span<const uint8_t> data);

}  // namespace wellspring::store
