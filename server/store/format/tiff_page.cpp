// SPDX-License-Identifier: Apache-2.0
#include "store/format/tiff_page.h"

#include "base/load_error.h"

namespace wellspring::store {

BandCode code_of(const TiffPage& page) {
  return page.is_float ? BandCode::f32 : page.bits == 16 ? BandCode::u16 : BandCode::u8;
}

void check_stored(const TiffPage& page, int64_t file_bytes, const std::string& file) {
  const double bytes =
      double(page.width) * double(page.height) * double(page.bits * page.channels) / 8;
  if (bytes / double(page.most_packed) > double(file_bytes))
    throw LoadError(file, page.name,
                    "picture of " + std::to_string(page.width) + " x " +
                        std::to_string(page.height) + " texels is in a file of " +
                        std::to_string(file_bytes) + " bytes");
}

}  // namespace wellspring::store
