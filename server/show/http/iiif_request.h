// SPDX-License-Identifier: Apache-2.0
// Reads what a client of the IIIF Image API 3.0 asks for: which part of a picture, how large, how
// turned, in which colours and format. https://iiif.io/api/image/3.0/#4-image-requests
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "base/layers.h"

namespace wellspring::show {

inline constexpr int most_iiif_side = 4096;  // pixels of an answer's longer side

// Holds a request of the grammar whose picture can be made.
struct IiifRequest {
  enum class Quality : uint8_t { color, gray, bitonal };
  enum class Format : uint8_t { jpg, png };

  int64_t x = 0, y = 0, region_width = 1, region_height = 1;  // texels, within the picture
  int width = 1, height = 1;                                  // pixels, before it is turned
  bool is_mirrored = false;                                   // left and right, before it is turned
  int quarter_turns = 0;                                      // clockwise
  Quality quality = Quality::color;
  Format format = Format::jpg;

  // Says whether pixels are as the region's but for their number.
  bool is_plain() const { return !is_mirrored && quarter_turns == 0 && quality == Quality::color; }
  bool operator==(const IiifRequest&) const = default;
};

struct IiifQuestion {
  IiifRequest request;
  std::string canonical;  // the one address of this picture (section 4.7)
  int status = 200;       // status of HTTP; 200: `request` may be answered
  std::string problem;    // otherwise the fault
};

// Reads REGION/SIZE/ROTATION/QUALITY.FORMAT for a picture of this size, which is at least 1 x 1.
IiifQuestion read_iiif_request(std::string_view text, int64_t width, int64_t height);

// Returns the size of `size` max for a picture, or a region of it.
struct IiifSize {
  int width = 1, height = 1;
};
IiifSize largest_iiif_size(int64_t width, int64_t height);

}  // namespace wellspring::show
