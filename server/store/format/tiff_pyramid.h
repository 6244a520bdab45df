// SPDX-License-Identifier: Apache-2.0
// Opens TIFF and BigTIFF files: pyramids of tiles in pages or SubIFDs, tiles or strips alone.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "base/clock.h"
#include "store/bands/band_view.h"
#include "store/picture/kept_levels.h"

namespace wellspring::store {

// A file of strips is read whole, and one of tiles without smaller versions is read once to make
// them; both only up to `most_texels`. Pages of other pictures, such as labels, are left out. The
// first page's colour profile and orientation are applied to all.
//
// A tiled file that is replaced by one with the same levels while it is shown is read from then on,
// within seconds of `clock` for new pieces and a minute for others; levels that no file has stay as
// they were. One with other levels is logged, and the old one stays open. The same goes for the
// description of its bands beside it.
//
// Texels of a picture of many bands are shown as `view` says.
std::shared_ptr<const PicturePyramid> load_tiff(const std::string& file,
                                                int64_t most_texels = most_whole_texels,
                                                std::function<double()> clock = seconds_now,
                                                const BandView& view = {});

}  // namespace wellspring::store
