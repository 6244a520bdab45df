// SPDX-License-Identifier: Apache-2.0
// Reads an info.json of the IIIF Image API, versions 1.0, 1.1, 2 and 3: which levels and tiles a
// picture has. https://iiif.io/api/image/3.0/#5-image-information
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "store/picture/pyramid.h"

namespace wellspring::store {

struct IiifInfo {
  int version = 0;                // the interface: 1, 2, 3
  int compliance = 0;             // its profile's level: 0, 1, 2
  int64_t width = 0, height = 0;  // texels of the picture
  std::string format = "jpg";     // format in which tiles are asked for
  std::vector<PyramidLevel> levels;
  std::vector<int64_t> scales;  // one a level; 0: it is known by its size alone

  bool is_one_tile(int level) const;
};

// Says what an info.json stands before: files, which have the tiles that it names, or a server,
// which makes others if its compliance is 1 or 2.
enum class IiifHost : uint8_t { folder, server };

// Reads its text; `file` is for errors, which name the place as a JSON pointer. If it names neither
// tiles nor sizes, tiles are as large as OpenSeadragon asks for: the largest of 1024, 512 and 256
// that is not longer than the shorter side, else that side. A server of level 1 or 2 has levels
// down to one that fits into a tile; one of level 0 has to name its tiles or its sizes.
IiifInfo read_iiif_info(const std::string& file, std::string_view text, IiifHost host);

// Holds a part of the picture, in texels of its full size.
struct IiifRegion {
  int64_t x = 0, y = 0, width = 0, height = 0;
};
IiifRegion region_of(const IiifInfo& info, PieceKey key);
std::string to_text(const IiifRegion& region);  // "x,y,w,h"

}  // namespace wellspring::store
